#include "tools/bench/truth.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace clearance::bench {
namespace {

using Real = long double;
using Matrix = Eigen::Matrix<Real, 3, 3>;

// The rotation matrix of q / |q|, as N(q) / |q|^2.
Matrix rotation(const Eigen::Quaterniond& unnormalised) {
  const Eigen::Quaternion<Real> q = unnormalised.cast<Real>();
  const Real s = 2.0L / q.squaredNorm();
  Matrix cross;
  cross << 0, -q.z(), q.y(), q.z(), 0, -q.x(), -q.y(), q.x(), 0;
  return Matrix::Identity() + s * (q.w() * cross + cross * cross);
}

}  // namespace

TrueDistance::TrueDistance(const ConvexBody& a, const ConvexBody& b) : a_(a), b_(b) {}

TrueDistance::Point TrueDistance::support(const ConvexBody& body, const Point& along) {
  const CurvedShape& shape = body.curved;
  if (shape.kind == CurvedShape::Kind::kEllipsoid) {
    const Point axes = shape.semi_axes.cast<Real>(), scaled = axes.cwiseProduct(along);
    return axes.cwiseProduct(scaled) / scaled.norm();
  }
  Point best = Point::Zero();
  Real highest = -std::numeric_limits<Real>::infinity();
  const auto offer = [&](const Point& point) {
    const Real value = along.dot(point);
    if (value > highest) {
      highest = value;
      best = point;
    }
  };
  if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
    const Point across = Point(along.x(), along.y(), 0.0L).stableNormalized();
    for (const Disc& disc : shape.discs) {
      offer(Point(0.0L, 0.0L, disc.height) + static_cast<Real>(disc.radius) * across);
    }
  }
  for (const Vertex& vertex : body.vertices) offer(vertex.position.cast<Real>());
  return best;
}

void TrueDistance::place(Corner& corner) const {
  corner.point = apart_ + world_from_b_ * corner.own_b - world_from_a_ * corner.own_a;
}

TrueDistance::Corner TrueDistance::support_point(const Point& against) const {
  Corner found;
  found.own_a = support(a_, world_from_a_.transpose() * against);
  found.own_b = support(b_, -(world_from_b_.transpose() * against));
  found.weight = 0.0L;
  place(found);
  return found;
}

TrueDistance::Point TrueDistance::nearest() const {
  Point sum = Point::Zero();
  for (const Corner& c : corners_) sum += c.weight * c.point;
  return sum;
}

// Wolfe's minor cycle: to the nearest point of the vertices' affine hull, dropping vertices whose
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
  apart_ = world_from_b.position.cast<Real>() - world_from_a.position.cast<Real>();
  world_from_a_ = rotation(world_from_a.orientation);
  world_from_b_ = rotation(world_from_b.orientation);
  for (Corner& c : corners_) {
    place(c);
    c.weight = 1.0L / static_cast<Real>(corners_.size());
  }
  if (corners_.empty()) {
    corners_.push_back(support_point(apart_));
    corners_[0].weight = 1.0L;
  }
  constexpr int kRounds = 1000;
  Truth best{0.0, kInfinity};
  for (int round = 0; round < kRounds; ++round) {
    minimise();
    const Point v = nearest();
    const Real length = v.norm();
    if (length < 1e-16L || corners_.size() == 4) return {0.0, 0.0};
    const Corner next = support_point(v);
    const Real gap = length - v.dot(next.point) / length;
    if (static_cast<double>(gap) < best.gap) {
      const Real radii = static_cast<Real>(a_.radius) + static_cast<Real>(b_.radius);
      best = {std::max(0.0, static_cast<double>(length - radii)),
              std::max(0.0, static_cast<double>(gap)), (v / length).cast<double>()};
    }
    const bool known = std::any_of(corners_.begin(), corners_.end(), [&](const Corner& c) {
      return c.own_a == next.own_a && c.own_b == next.own_b;
    });
    if (known || gap <= 1e-18L * length) break;
    corners_.push_back(next);
  }
  return best;
}

}  // namespace clearance::bench
