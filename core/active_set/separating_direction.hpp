// The direction from A's point to B's as the features define it. The difference of two rounded
// points would carry cancellation errors; this direction does not.
#pragma once

#include "core/active_set/active_feature.hpp"

namespace clearance {

struct SeparatingDirection {
  Vec3 vector;  // frame A, from A towards B; its length is the features' distance, m
  // The unit vector is correct to rounding: orthogonal to every active edge, or along the facet's
  // normal.
  bool exact = false;
};

namespace direction_case {

// Below this sine the cross product of two edges has lost too many digits of its direction.
inline constexpr double kShortest = 1e-5;

inline Vec3 across(const Vec3& v, const Vec3& e) noexcept { return v - v.dot(e) * e; }
// A unit vector rotated in doubles is not quite of unit length.
inline Vec3 along(const ActiveFeature& s) noexcept {
  return s.direction_to_a(s.edge().direction).normalized();
}
inline Vec3 normal_of(const ActiveFeature& s) noexcept {
  return s.direction_to_a(s.facet().normal).normalized();
}

// A direction at right angles to e and f, each of them unit or zero, up to rounding, however nearly
// parallel the two are.
inline Vec3 across_both(const Vec3& e, const Vec3& f) noexcept {
  if (e.isZero(0.0)) return f.isZero(0.0) ? Vec3::UnitZ() : f.unitOrthogonal();
  const Vec3 difference = e.dot(f) < 0.0 ? Vec3(f + e) : Vec3(f - e);
  const Vec3 across = e.cross(difference).normalized();
  if (across.isZero(0.0)) return e.unitOrthogonal();
  return (across - across.dot(e) * e).normalized();
}

inline SeparatingDirection edge_edge(const ActiveFeature& a, const ActiveFeature& b,
                                     const Vec3& between) noexcept {
  const Vec3 e = along(a), f = along(b);
  const Vec3 n = e.cross(f);
  const double sine2 = n.squaredNorm();
  if (sine2 > kShortest * kShortest) return {(n.dot(between) / sine2) * n, true};
  return {across(across(across(between, f), e), f), false};
}

inline SeparatingDirection from_facet(const Vec3& normal, const Vec3& between,
                                      bool other_is_vertex) noexcept {
  return {normal.dot(between) * normal, other_is_vertex};
}

}  // namespace direction_case

[[nodiscard]] inline SeparatingDirection separating_direction(const ActiveFeature& a,
                                                              const ActiveFeature& b) noexcept {
  using namespace direction_case;
  const Vec3 between = b.point_A() - a.point_A();
  const bool a_vertex = a.feature() == FeatureKind::kVertex,
             b_vertex = b.feature() == FeatureKind::kVertex;
  if (a.feature() == FeatureKind::kFacet) return from_facet(a.facet().normal, between, b_vertex);
  if (b.feature() == FeatureKind::kFacet) {
    return from_facet(normal_of(b), between, a_vertex);
  }
  const bool a_edge = a.feature() == FeatureKind::kEdge, b_edge = b.feature() == FeatureKind::kEdge;
  if (a_edge && b_edge) return edge_edge(a, b, between);
  if (a_edge && b_vertex) return {across(across(between, along(a)), along(a)), true};
  if (b_edge && a_vertex) return {across(across(between, along(b)), along(b)), true};
  return {between, a_vertex && b_vertex};
}

}  // namespace clearance
