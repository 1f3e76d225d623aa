#include "core/curved/half_space.hpp"

#include <cmath>

#include "core/curved/conclusion.hpp"
#include "core/curved/piece.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// As of CurvedPair::error(), of the body's reach; of the plane's offset, and of the offset between
// the origins. The facet's normal is rounded, too: 1 of each.
constexpr double kUlpsOfBody = 27, kUlpsOfPlane = 5, kUlpsOfOrigins = 13;

Vec3 farthest_point(const ConvexBody& body, const Vec3& m) noexcept {
  const PieceSource source{&body, body.bounding_radius};
  return support_point(source, farthest_piece(source, m), m);
}

double error_of(double reach, double plane, const RelativePose& pose) noexcept {
  const double offset = pose.translation.norm();
  return kUlp * (kUlpsOfBody * reach + kUlpsOfPlane * plane + kUlpsOfOrigins * offset) +
         pose.translation_error + pose.rotation_error * kRoundedUp * (reach + offset) + kUnderflow;
}

}  // namespace

DistanceResult distance_of_half_space(const ConvexBody& a, const ConvexBody& b,
                                      const RelativePose& a_from_b,
                                      CurvedTrackingState& state) noexcept {
  const bool of_a = a.is_half_space();
  const ConvexBody &plane = of_a ? a : b, &body = of_a ? b : a;
  const Facet& facet = plane.facets.front();
  const Mat3& turn = a_from_b.rotation;
  CurvedConclusion found;
  Vec3 to_body = facet.normal, point;  // frame A
  if (of_a) {
    point = turn * farthest_point(body, -(turn.transpose() * facet.normal)) + a_from_b.translation;
    found.lower = facet.normal.dot(point) - facet.offset;
  } else {
    to_body = turn * facet.normal;
    point = farthest_point(body, -to_body);
    found.lower = to_body.dot(point - a_from_b.translation) - facet.offset;
  }
  const Vec3 on_plane = point - found.lower * to_body;
  found.upper = found.lower;
  found.normal = of_a ? to_body : Vec3(-to_body);
  found.point_on_a = of_a ? on_plane : point;
  found.point_on_b = of_a ? point : on_plane;
  found.radius_a = a.radius;
  found.radius_b = b.radius;
  found.error = error_of(body.bounding_radius, std::abs(facet.offset), a_from_b);
  found.size = body.bounding_radius + std::abs(facet.offset) + a_from_b.translation.norm();
  state.own_point_on_b = turn.transpose() * (found.point_on_b - a_from_b.translation);
  state.shared =
      found.lower < 0.0 ? point : between(found.point_on_a, found.point_on_b, a.radius, b.radius);
  return conclude(found);
}

}  // namespace clearance
