#include "core/curved/curved_pair.hpp"

#include <algorithm>

#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// In ulps of A's reach, of B's and of the offset between their origins. A support point: the
// products with the semi-axes 2, a norm 2.5, a quotient 1; pulled inside, as much again. B's: the
// direction turned to B's frame 4, the point turned back 4. Placing it and the difference 2, its
// product with n 3, n's length 2.5. tests/core/curved compares with exact answers.
constexpr double kUlpsOfA = 18, kUlpsOfB = 26, kUlpsOfOffset = 12;

}  // namespace

CurvedPair::CurvedPair(const CurvedBody& body_a, const CurvedBody& body_b,
                       const RelativePose& a_from_b) noexcept
    : a{&body_a}, b{&body_b}, pose_(a_from_b) {
  size = body_a.reach + body_b.reach + a_from_b.translation.norm();
}

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
  const double offset = pose_.translation.norm();
  const double farthest = std::max(0.0, std::min(bounds.upper, size));
  const double turned =
      std::min(b.body->reach, a.body->reach + offset + kStretched * farthest) * kRoundedUp;
  const double ulps = kUlpsOfA * a.body->reach + kUlpsOfB * b.body->reach + kUlpsOfOffset * offset;
  return kUlp * ulps + pose_.translation_error + pose_.rotation_error * turned + kUnderflow;
}

}  // namespace clearance
