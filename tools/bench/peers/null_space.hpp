// The linear algebra of a small primal active-set method: an updated orthonormal basis of the
// active rows, and least squares in their null space. The basis is found by Gram-Schmidt
// orthogonalisation. Each step is done twice, which is enough for orthogonality to rounding (W.
// Kahan and B. Parlett, "twice is enough").
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace clearance::bench {

class NullSpace {
 public:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Wide = Eigen::Matrix<double, 3, 6>;

  [[nodiscard]] int size() const { return size_; }
  void resize(int size) { size_ = size; }  // keeps the first ones

  // Rows must be independent.
  void add(const Vec6& row) {
    Vec6 left = row;
    r_.col(size_).setZero();
    for (int pass = 0; pass < 2; ++pass) {
      for (int i = 0; i < size_; ++i) {
        const double along = q_.col(i).dot(left);
        r_(i, size_) += along;
        left -= along * q_.col(i);
      }
    }
    r_(size_, size_) = left.norm();
    q_.col(size_) = left / r_(size_, size_);
    ++size_;
  }

  // The multipliers: sum of multiplier[k] * row k is `gradient`, as nearly as it can be.
  [[nodiscard]] Vec6 multipliers(const Vec6& gradient) const {
    Vec6 m = Vec6::Zero();
    for (int i = size_ - 1; i >= 0; --i) {
      double sum = q_.col(i).dot(gradient);
      for (int k = i + 1; k < size_; ++k) sum -= r_(i, k) * m[k];
      m[i] = sum / r_(i, i);
    }
    return m;
  }

  // The shortest p with rows.p = 0 that makes |jacobian p + residual| least.
  [[nodiscard]] Vec6 least_squares(const Wide& jacobian, const Eigen::Vector3d& residual) const {
    Eigen::Matrix<double, 6, 3> left = jacobian.transpose();  // the component in the null space of
                                                              // its rows
    for (int i = 0; i < size_; ++i) left -= q_.col(i) * (q_.col(i).transpose() * left);
    Eigen::Matrix<double, 6, 3> basis;
    Eigen::Matrix3d image, triangle;
    Eigen::Vector3d projected;
    Eigen::Vector3d rest = -residual;
    int rank = 0;
    for (; rank < 3; ++rank) {
      Eigen::Index longest = 0;
      const double length2 = left.colwise().squaredNorm().maxCoeff(&longest);
      if (!(length2 > kDependent * kDependent)) break;
      Vec6 w = left.col(longest) / std::sqrt(length2);
      for (int i = 0; i < size_; ++i) w -= q_.col(i).dot(w) * q_.col(i);
      for (int i = 0; i < rank; ++i) w -= basis.col(i).dot(w) * basis.col(i);
      w.normalize();
      basis.col(rank) = w;
      left -= w * (w.transpose() * left);
      // The vector's image under the jacobian, orthogonal to those before: one column of a QR.
      Eigen::Vector3d seen = jacobian * w;
      for (int pass = 0; pass < 2; ++pass) {
        for (int i = 0; i < rank; ++i) {
          const double along = image.col(i).dot(seen);
          triangle(i, rank) = (pass == 0 ? 0.0 : triangle(i, rank)) + along;
          seen -= along * image.col(i);
        }
      }
      triangle(rank, rank) = seen.norm();
      image.col(rank) = seen / triangle(rank, rank);
      projected[rank] = image.col(rank).dot(rest);
      rest -= projected[rank] * image.col(rank);
    }
    Vec6 p = Vec6::Zero();
    for (int i = rank - 1; i >= 0; --i) {
      const double y = projected[i] / triangle(i, i);
      for (int k = 0; k < i; ++k) projected[k] -= triangle(k, i) * y;
      p += y * basis.col(i);
    }
    return p;
  }

 private:
  // Unit vectors this close to the span of others are in it.
  static constexpr double kDependent = 1e-13;

  Eigen::Matrix<double, 6, 6> q_, r_;  // active rows = q r
  int size_ = 0;
};

}  // namespace clearance::bench
