// The distance as the quadratic programme (3.2.5), which has six variables and N1 + N2 rows. It is
// solved by a general primal active-set method (§3.3.2, Fletcher) that knows nothing of geometry.
//
// Each body's point is kept in the body's local frame, and |x1 - R x2 - t|^2 is minimised. So the
// rows do not change when bodies move, and a tracked start is feasible. The objective is treated as
// a least-squares problem, which keeps the digits that forming H = J'J loses. The equality problem
// is solved in the null space of the active rows. The slacks d - n.x are updated, so alpha costs
// one product with the rows.
#pragma once

#include <algorithm>
#include <vector>

#include "core/pose.hpp"
#include "tools/bench/peers/null_space.hpp"

namespace clearance::bench {

// One body's half-spaces, n.x <= d in its own frame.
struct QpRows {
  Eigen::Matrix<double, Eigen::Dynamic, 3> normals;
  Eigen::VectorXd offsets;
};

struct QpEnd {
  double distance;
  bool ok;  // false: not finished after kIterations
  int iterations;
};

// Keeps x and the active set from one solve() to the next.
class ActiveSetQp {
 public:
  using Vec6 = NullSpace::Vec6;

  // The rows must outlive it.
  ActiveSetQp(const QpRows& a, const QpRows& b)
      : a_(a), b_(b), slack_(a.offsets.size() + b.offsets.size()), speed_(slack_.size()) {}

  // Starts from points of the bodies, each in its local frame, with no active constraint.
  void start(const Vec3& on_a, const Vec3& on_b) {
    active_.clear();
    free_.resize(0);
    x_ << on_a, on_b;
  }
  [[nodiscard]] Vec3 on_a() const { return x_.head<3>(); }
  [[nodiscard]] Vec3 on_b() const { return x_.tail<3>(); }
  // Indices of active rows. The rows of B are numbered after those of A.
  [[nodiscard]] const std::vector<Eigen::Index>& active() const { return active_; }

  [[nodiscard]] QpEnd solve(const Mat3& a_from_b, const Vec3& t) {
    jacobian_.leftCols<3>().setIdentity();
    jacobian_.rightCols<3>() = -a_from_b;
    slack_ << a_.offsets, b_.offsets;
    product(x_);
    slack_ -= speed_;

    QpEnd answer{0.0, false, 0};
    int idle = 0;  // steps of no length since the last one
    while (answer.iterations < kIterations) {
      ++answer.iterations;
      const Vec3 residual = jacobian_ * x_ - t;
      answer.distance = residual.norm();
      const bool full = step(residual, idle);
      if (!full) continue;
      const Vec3 left = jacobian_ * x_ - t;
      answer.distance = left.norm();
      if (answer.distance < kContact || !release(left, idle > kIdle)) {
        answer.ok = true;
        break;
      }
    }
    return answer;
  }

 private:
  static constexpr int kIterations = 5000;
  // This many steps of length zero may be cycling. Later steps follow Bland's rule, the smallest
  // index.
  static constexpr int kIdle = 20;
  static constexpr double kContact = 1e-13;  // m
  static constexpr double kRounding = 1e-14;

  [[nodiscard]] Vec6 row(Eigen::Index i) const {
    Vec6 r = Vec6::Zero();
    if (i < a_.offsets.size()) {
      r.head<3>() = a_.normals.row(i);
    } else {
      r.tail<3>() = b_.normals.row(i - a_.offsets.size());
    }
    return r;
  }

  // speed_ = rows * v
  void product(const Vec6& v) {
    speed_.head(a_.offsets.size()).noalias() = a_.normals * v.head<3>();
    speed_.tail(b_.offsets.size()).noalias() = b_.normals * v.tail<3>();
  }

  // Moves by delta, as far as alpha allows. Returns true if no row blocked the move.
  bool step(const Vec3& residual, int& idle) {
    const Vec6 move = free_.least_squares(jacobian_, residual);
    const double length = move.norm();
    if (length <= kRounding * (1.0 + x_.norm())) return true;
    product(move);
    for (const Eigen::Index i : active_) speed_[i] = 0.0;
    double alpha = 1.0;
    Eigen::Index blocking = -1;
    for (Eigen::Index i = 0; i < speed_.size(); ++i) {
      if (!(speed_[i] > kRounding * length) || slack_[i] >= alpha * speed_[i]) continue;
      alpha = std::max(0.0, slack_[i] / speed_[i]);
      blocking = i;
    }
    x_ += alpha * move;
    slack_ -= alpha * speed_;
    idle = alpha * length > kRounding ? 0 : idle + 1;
    if (blocking < 0) return true;
    active_.push_back(blocking);
    free_.add(row(blocking));
    return false;
  }

  // Releases the active row with the most negative multiplier (lambda), or by Bland's rule the one
  // with the smallest index. Returns false if no multiplier is negative.
  bool release(const Vec3& residual, bool smallest_index) {
    if (active_.empty()) return false;
    const Vec6 gradient = jacobian_.transpose() * residual;
    const Vec6 lambda = free_.multipliers(-gradient);
    int leaving = -1;
    for (int k = 0; k < free_.size(); ++k) {
      if (lambda[k] >= -kRounding * gradient.norm()) continue;
      const bool better = leaving < 0 || (smallest_index ? active_[k] < active_[leaving]
                                                         : lambda[k] < lambda[leaving]);
      if (better) leaving = k;
    }
    if (leaving < 0) return false;
    active_.erase(active_.begin() + leaving);
    free_.resize(leaving);
    for (std::size_t k = leaving; k < active_.size(); ++k) free_.add(row(active_[k]));
    return true;
  }

  const QpRows& a_;
  const QpRows& b_;
  NullSpace::Wide jacobian_;
  Vec6 x_;  // of A in its frame, of B in its frame
  std::vector<Eigen::Index> active_;
  NullSpace free_;  // of the active rows, in their order
  Eigen::VectorXd slack_, speed_;
};

}  // namespace clearance::bench
