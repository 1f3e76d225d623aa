#include "core/curved/symmetric_depth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace clearance {
namespace {

constexpr double kTolerance = 0x1p-49;  // of the pair's size
constexpr int kMostArcs = 1000;

// ---- balls ----
// Inside the body, around `centre`.
struct InnerBall {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
};
InnerBall inner_ball(const ConvexBody& body) noexcept {
  switch (body.curved.kind) {
    case CurvedShape::Kind::kNone:
      return {body.interior, body.inner_radius};
    case CurvedShape::Kind::kEllipsoid:
      return {Vec3::Zero(), body.curved.semi_axes.minCoeff()};
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  const auto& [low, high] = body.curved.discs;
  if (low.radius != high.radius) return {};
  return {Vec3(0.0, 0.0, 0.5 * (low.height + high.height)),
          std::min(low.radius, 0.5 * (high.height - low.height))};
}

double by_balls(const CurvedPair& pair) noexcept {
  const InnerBall a = inner_ball(*pair.a.body), b = inner_ball(*pair.b.body);
  return a.radius + b.radius - (pair.point_to_a(b.centre) - a.centre).norm();
}

// ---- ellipsoids with the same axes ----
// h_A + h_B is a sum of square roots of linear functions of the squares of n's coordinates, which
// is concave: over the simplex of these squares it is least at a corner.
double by_semi_axes(const CurvedPair& pair) noexcept {
  const CurvedShape &a = pair.a.body->curved, &b = pair.b.body->curved;
  if (a.kind != CurvedShape::Kind::kEllipsoid || b.kind != a.kind) return -kInfinity;
  double least = kInfinity, off = 0.0;
  for (int i = 0; i < 3; ++i) {
    int axis = 0;
    const double along = pair.rotation().row(i).cwiseAbs().maxCoeff(&axis);
    least = std::min(least, a.semi_axes[i] + b.semi_axes[axis]);
    for (int k = 0; k < 3; ++k) {
      const double entry = std::abs(pair.rotation()(i, k));
      off += k == axis ? 1.0 - along : entry;
    }
  }
  return least - pair.translation().norm() - off * pair.b.reach;
}

// ---- solids of revolution ----
constexpr int kAnyAxis = 3;
// Around which of its axes; kAnyAxis: a sphere; kNone: around none.
int axis_of(const ConvexBody& body) noexcept {
  if (body.curved.kind == CurvedShape::Kind::kTruncatedCone) return 2;
  if (body.curved.kind == CurvedShape::Kind::kNone) return kNone;
  const Vec3& s = body.curved.semi_axes;
  if (s.x() == s.y()) return s.y() == s.z() ? kAnyAxis : 2;
  if (s.y() == s.z()) return 0;
  return s.x() == s.z() ? 1 : kNone;
}

// In a half-plane that the axis bounds: x along the axis, y away from it.
struct Section {
  const CurvedShape& shape;
  int axis;

  [[nodiscard]] Vec2 support(const Vec2& n) const noexcept {
    if (shape.kind == CurvedShape::Kind::kTruncatedCone) {
      const Vec2 low(shape.discs[0].height, shape.discs[0].radius);
      const Vec2 high(shape.discs[1].height, shape.discs[1].radius);
      return n.dot(high) > n.dot(low) ? high : low;
    }
    const int along = axis == kAnyAxis ? 0 : axis;
    const Vec2 semi_axes(shape.semi_axes[along], shape.semi_axes[(along + 1) % 3]);
    const Vec2 scaled = semi_axes.cwiseProduct(n);
    return semi_axes.cwiseProduct(scaled) / scaled.norm();
  }
};

// Of A - B: a direction, unit, and the point farthest along it.
struct SectionCorner {
  Vec2 normal, point;
};

// Directions from one end of the axis to the other, in arcs that are halved until each has nothing
// less than the best but for the tolerance. Any mean p of an arc's two points bounds it by the
// lesser of n.p at its ends, as a triangle of directions does (depth.hpp).
class SectionSearch {
 public:
  SectionSearch(const Section& a, const Section& b, double apart, bool opposite) noexcept
      : a_(a), b_(b), apart_(apart), turn_(opposite ? -1.0 : 1.0) {}

  [[nodiscard]] double run(double tolerance) noexcept {
    std::array<SectionCorner, 3> start{corner({1.0, 0.0}), corner({0.0, 1.0}), corner({-1.0, 0.0})};
    stack_[0] = {start[0], start[1]};
    stack_[1] = {start[1], start[2]};
    std::size_t count = 2;
    double least = kInfinity;
    for (int arcs = 0; count > 0; ++arcs) {
      const Arc arc = stack_[--count];
      const double bound = value(arc);
      const bool tight = bound > 0.0 && bound >= best_ - tolerance;
      if (tight || arcs >= kMostArcs || count + 2 > stack_.size()) {
        least = std::min(least, bound);
        continue;
      }
      const SectionCorner middle = corner((arc.from.normal + arc.to.normal).normalized());
      stack_[count++] = {arc.from, middle};
      stack_[count++] = {middle, arc.to};
    }
    return least > 0.0 ? least : -kInfinity;
  }

 private:
  struct Arc {
    SectionCorner from, to;
  };

  SectionCorner corner(const Vec2& n) noexcept {
    const Vec2 of_a = a_.support(n), of_b = b_.support({-turn_ * n.x(), n.y()});
    const SectionCorner found{n, Vec2(of_a.x() - (apart_ + turn_ * of_b.x()), of_a.y() + of_b.y())};
    best_ = std::min(best_, n.dot(found.point));
    return found;
  }

  [[nodiscard]] static double value(const Arc& arc) noexcept {
    const auto& [from, to] = arc;
    const double a = from.normal.dot(from.point), b = from.normal.dot(to.point);
    const double c = to.normal.dot(from.point), d = to.normal.dot(to.point);
    double best = std::max(std::min(a, c), std::min(b, d));
    const double part = (a - c) / ((a - c) + (d - b));
    if (part > 0.0 && part < 1.0) {
      best = std::max(best, std::min(a + part * (b - a), c + part * (d - c)));
    }
    return best;
  }

  Section a_, b_;
  double apart_, turn_;
  double best_ = kInfinity;
  std::array<Arc, 64> stack_{};
};

double by_sections(const CurvedPair& pair) noexcept {
  const int of_a = axis_of(*pair.a.body), of_b = axis_of(*pair.b.body);
  if (of_a == kNone || of_b == kNone) return -kInfinity;
  // Frame A, and how far off B's own axis is, as a sine.
  Vec3 axis = pair.translation();
  if (of_a != kAnyAxis) {
    axis = Vec3::Unit(of_a);
  } else if (of_b != kAnyAxis) {
    axis = pair.rotation().col(of_b);
  } else if (axis.isZero(0.0)) {
    return -kInfinity;  // spheres around one centre: by_balls() has it
  } else {
    axis = unit_along(axis);
  }
  double tilt = 0.0, cosine = 1.0;
  if (of_b != kAnyAxis) {
    const Vec3 own = pair.rotation().col(of_b);
    tilt = axis.cross(own).norm();
    cosine = axis.dot(own);
  }
  const double along = axis.dot(pair.translation());
  const double aside = (pair.translation() - along * axis).norm();
  if (!(tilt < 0.5)) return -kInfinity;
  SectionSearch search({pair.a.body->curved, of_a}, {pair.b.body->curved, of_b}, along,
                       cosine < 0.0);
  // An angle is no more than 1.05 times its sine, up to 30 degrees.
  return search.run(kTolerance * pair.size) - aside - 1.05 * tilt * pair.b.reach;
}

}  // namespace

double rolling_ball(const ConvexBody& body) noexcept {
  if (body.curved.kind != CurvedShape::Kind::kEllipsoid) return 0.0;
  const double least = body.curved.semi_axes.minCoeff();
  return least * (least / body.curved.semi_axes.maxCoeff());
}

double least_symmetric_depth(const CurvedPair& pair) noexcept {
  if (!pair.a.body->bounded() || !pair.b.body->bounded()) return -kInfinity;
  return std::max({by_balls(pair), by_semi_axes(pair), by_sections(pair)});
}

}  // namespace clearance
