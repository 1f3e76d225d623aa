#include "core/curved/curved_pair.hpp"

namespace clearance {
namespace {

// No closest point of `body` is farther from its frame's origin than this, m. The sum of these
// three lengths bounds the distance of one of its `anchors` from any point of the other body.
double farthest_closest(const ConvexBody& body, const ConvexBody& other,
                        const RelativePose& a_from_b) noexcept {
  const double to_other = a_from_b.translation.norm() + other.bounding_radius;
  return 2.0 * to_other + body.bounding_radius;
}

}  // namespace

CurvedPair::CurvedPair(const ConvexBody& body_a, const ConvexBody& body_b,
                       const RelativePose& a_from_b) noexcept
    : a(view_of(body_a, farthest_closest(body_a, body_b, a_from_b))),
      b(view_of(body_b, farthest_closest(body_b, body_a, a_from_b))),
      size(size_of(body_a, body_b, a_from_b.translation.norm())),
      pose_(a_from_b) {}

SupportPair CurvedPair::support_of(const PartPair& parts, const Vec3& n) const noexcept {
  SupportPair found{parts, {}, 0.0};
  found.points.a = support_point(a, parts.a, n);
  found.points.b_B = support_point(b, parts.b, -direction_to_b(n));
  found.points.b = point_to_a(found.points.b_B);
  found.value = n.dot(found.points.gap());
  return found;
}

SupportPair CurvedPair::support_along(const Vec3& n) const noexcept {
  return support_of({support_part(a, n), support_part(b, -direction_to_b(n))}, n);
}

SupportPair CurvedPair::support(const Vec3& n) noexcept {
  const SupportPair found = support_along(n);
  if (found.value > bounds.lower) {
    bounds.lower = found.value;
    bounds.normal = n;
  }
  return found;
}

void CurvedPair::prefer(const Vec3& n) noexcept {
  const double before = bounds.lower;
  bounds.lower = -kInfinity;
  const Vec3 normal_before = bounds.normal;
  (void)support(n);
  if (bounds.lower >= before - gap_tolerance()) return;
  bounds.lower = before;
  bounds.normal = normal_before;
}

PointPair CurvedPair::add_points(const Vec3& on_a, const Vec3& b_B) noexcept {
  PointPair points{pulled_inside(a, on_a), pulled_inside(b, b_B), {}};
  points.b = point_to_a(points.b_B);
  const double length = points.gap().norm();
  if (length < bounds.upper) {
    bounds.upper = length;
    bounds.points = points;
  }
  return points;
}

double CurvedPair::error() const noexcept {
  return rounding_error(a, b,
                        {pose_.rotation_error, pose_.translation_error, pose_.translation.norm()},
                        bounds.upper, size);
}

}  // namespace clearance
