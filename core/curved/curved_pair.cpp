#include "core/curved/curved_pair.hpp"

namespace clearance {
namespace {

// No closest point of `body` is farther from its frame's origin than this, m: one of its anchors is
// within all three lengths of any point of the other one.
double farthest_closest(const ConvexBody& body, const ConvexBody& other,
                        const RelativePose& a_from_b) noexcept {
  const double apart = a_from_b.translation.norm() + other.bounding_radius;
  return 2.0 * apart + body.bounding_radius;
}

}  // namespace

CurvedPair::CurvedPair(const ConvexBody& body_a, const ConvexBody& body_b,
                       const RelativePose& a_from_b) noexcept
    : a(source_of(body_a, farthest_closest(body_a, body_b, a_from_b))),
      b(source_of(body_b, farthest_closest(body_b, body_a, a_from_b))),
      size(body_a.bounding_radius + body_b.bounding_radius + a_from_b.translation.norm()),
      pose_(a_from_b) {}

SupportPair CurvedPair::support_of(const PiecePair& pieces, const Vec3& n) const noexcept {
  SupportPair found{pieces, {}, 0.0};
  found.points.a = support_point(a, pieces.a, n);
  found.points.own_b = support_point(b, pieces.b, -direction_to_b(n));
  found.points.b = point_to_a(found.points.own_b);
  found.apart = n.dot(found.points.difference());
  return found;
}

SupportPair CurvedPair::support(const Vec3& n) noexcept {
  const PiecePair pieces{farthest_piece(a, n), farthest_piece(b, -direction_to_b(n))};
  const SupportPair found = support_of(pieces, n);
  if (found.apart > bounds.lower) {
    bounds.lower = found.apart;
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

PointPair CurvedPair::add_points(const Vec3& on_a, const Vec3& own_b) noexcept {
  PointPair points{pulled_inside(*a.body, on_a), pulled_inside(*b.body, own_b), {}};
  points.b = point_to_a(points.own_b);
  const double apart = points.difference().norm();
  if (apart < bounds.upper) {
    bounds.upper = apart;
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
