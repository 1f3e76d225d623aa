#include "tools/bench/truth.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

namespace clearance::bench {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, 3, 3>;

Eigen::Matrix<Real, 3, Eigen::Dynamic> vertices(const ConvexPolyhedron& body) {
  Eigen::Matrix<Real, 3, Eigen::Dynamic> points(3, body.vertices.size());
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    points.col(static_cast<Eigen::Index>(i)) = body.vertices[i].position.cast<Real>();
  }
  return points;
}

// Of q / |q|, by N(q) / |q|^2.
Matrix rotation(const Eigen::Quaterniond& unnormalised) {
  const Eigen::Quaternion<Real> q = unnormalised.cast<Real>();
  const Real s = 2.0L / q.squaredNorm();
  Matrix cross;
  cross << 0, -q.z(), q.y(), q.z(), 0, -q.x(), -q.y(), q.x(), 0;
  return Matrix::Identity() + s * (q.w() * cross + cross * cross);
}

}  // namespace

TrueDistance::TrueDistance(const ConvexPolyhedron& a, const ConvexPolyhedron& b)
    : own_a_(vertices(a)), own_b_(vertices(b)) {}

TrueDistance::Corner TrueDistance::farthest(const Point& against) const {
  Eigen::Index of_a = 0, of_b = 0;
  (against.transpose() * a_).maxCoeff(&of_a);
  (against.transpose() * b_).minCoeff(&of_b);
  return {static_cast<int>(of_a), static_cast<int>(of_b), b_.col(of_b) - a_.col(of_a), 0.0L};
}

TrueDistance::Point TrueDistance::nearest() const {
  Point sum = Point::Zero();
  for (const Corner& c : corners_) sum += c.weight * c.point;
  return sum;
}

// Wolfe's minor cycle: to the nearest point of the corners' affine hull, dropping corners whose
// weight would become negative.
void TrueDistance::minimise() {
  while (corners_.size() > 1) {
    const auto others = static_cast<Eigen::Index>(corners_.size()) - 1;
    Eigen::Matrix<Real, 3, Eigen::Dynamic, 0, 3, 3> from_first(3, others);
    for (Eigen::Index i = 0; i < others; ++i) {
      from_first.col(i) = corners_[i + 1].point - corners_[0].point;
    }
    const Eigen::Matrix<Real, Eigen::Dynamic, 1> solved =
        from_first.colPivHouseholderQr().solve(-corners_[0].point);
    std::vector<Real> weight{1.0L - solved.sum()};
    for (Eigen::Index i = 0; i < others; ++i) weight.push_back(solved[i]);

    Real fraction = 1.0L;
    std::size_t leaving = corners_.size();
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (weight[i] > 0.0L) continue;
      const Real f = corners_[i].weight / (corners_[i].weight - weight[i]);
      if (leaving == corners_.size() || f < fraction) {
        fraction = f;
        leaving = i;
      }
    }
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      corners_[i].weight += fraction * (weight[i] - corners_[i].weight);
    }
    if (leaving == corners_.size()) return;
    corners_.erase(corners_.begin() + static_cast<std::ptrdiff_t>(leaving));
  }
  corners_[0].weight = 1.0L;
}

Truth TrueDistance::at(const Pose& world_from_a, const Pose& world_from_b) {
  const Point apart = world_from_b.position.cast<Real>() - world_from_a.position.cast<Real>();
  a_ = rotation(world_from_a.orientation) * own_a_;
  b_ = (rotation(world_from_b.orientation) * own_b_).colwise() + apart;
  for (Corner& c : corners_) {
    c.point = b_.col(c.b) - a_.col(c.a);
    c.weight = 1.0L / static_cast<Real>(corners_.size());
  }
  if (corners_.empty()) {
    corners_.push_back(farthest(apart));
    corners_[0].weight = 1.0L;
  }
  constexpr int kRounds = 1000;
  Truth best{0.0, kInfinity};
  for (int round = 0; round < kRounds; ++round) {
    minimise();
    const Point v = nearest();
    const Real length = v.norm();
    if (length < 1e-16L || corners_.size() == 4) return {0.0, 0.0};
    const Corner next = farthest(v);
    const Real gap = length - v.dot(next.point) / length;
    if (static_cast<double>(gap) < best.gap) {
      best = {static_cast<double>(length), std::max(0.0, static_cast<double>(gap))};
    }
    const bool known = std::any_of(corners_.begin(), corners_.end(),
                                   [&](const Corner& c) { return c.a == next.a && c.b == next.b; });
    if (known || gap <= 1e-18L * length) break;
    corners_.push_back(next);
  }
  return best;
}

}  // namespace clearance::bench
