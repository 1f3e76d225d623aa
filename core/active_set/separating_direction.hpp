// The direction from A's point to B's as the features define it, free of what cancellation leaves
// in the difference of two rounded points.
#pragma once

#include "core/active_set/active_feature.hpp"

namespace clearance {

struct SeparatingDirection {
  Vec3 vector;  // from A towards B, as long as the features are apart, common frame
  bool exact =
      false;  // unit vector good to rounding: at right angles to every active edge, along the facet
};

namespace direction_case {

// Edges whose cross product is shorter than this leave too little of its direction.
inline constexpr double kShortest = 1e-5;

inline Vec3 across(const Vec3& v, const Vec3& e) noexcept { return v - v.dot(e) * e; }
// Unit vectors that the rotation's doubles have turned are not quite of unit length.
inline Vec3 along(const ActiveFeature& s) noexcept {
  return s.direction_to_common(s.edge().direction).normalized();
}
inline Vec3 normal_of(const ActiveFeature& s) noexcept {
  return s.direction_to_common(s.facet().normal).normalized();
}

// A direction across two, each of them unit or zero: at right angles to both up to rounding,
// however nearly parallel they are.
inline Vec3 across_both(const Vec3& e, const Vec3& f) noexcept {
  if (e.isZero(0.0)) return f.isZero(0.0) ? Vec3::UnitZ() : f.unitOrthogonal();
  const Vec3 turned = e.dot(f) < 0.0 ? Vec3(f + e) : Vec3(f - e);
  const Vec3 across = e.cross(turned).normalized();
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
  const Vec3 between = b.common() - a.common();
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
