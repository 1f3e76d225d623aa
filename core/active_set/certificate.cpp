#include "core/active_set/certificate.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/active_set/separating_direction.hpp"
#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

using direction_case::across;
using direction_case::along;

// Adds v as a unit vector, unless it has no direction.
void add_direction(Separators& list, const Vec3& v) noexcept {
  const double length = v.norm();
  if (length > 0.0 && std::isfinite(length)) list.add({v / length});
}

void add_facets(Separators& list, const ActiveFeature& a, const ActiveFeature& b) noexcept {
  if (a.feature() == FeatureKind::kFacet) list.add({a.facet().normal, a.index(), kNone});
  if (b.feature() == FeatureKind::kFacet) {
    list.add({-direction_case::normal_of(b), kNone, b.index()});
  }
}

void add_crossing_edges(Separators& list, const ActiveFeature& a, const ActiveFeature& b,
                        const Vec3& between) noexcept {
  const Vec3 n = direction_case::across_both(along(a), along(b));
  add_direction(list, n.dot(between) < 0.0 ? Vec3(-n) : n);
}

// m: the support value of the body along `normal` (frame A), from the origin of the body's frame.
// For an unbounded body only points within `within` of the origin count. Along the normal of a
// facet it is the facet's offset, which needs no search.
double support_value(const ActiveFeature& s, const Vec3& normal, std::int32_t facet,
                     double within) noexcept {
  if (facet != kNone) return s.body().facets[facet].offset;
  const Vec3 m = s.direction_A_to_L(normal);
  return support(s.body(), m).value + support_along_rays(s.body(), m, within);
}

// Has every ray of the body a directional derivative along `normal` that is negative by more than
// rounding? No ray has a positive one along the normal of a facet of the body.
bool ends_along(const ActiveFeature& s, const Vec3& normal, std::int32_t facet,
                double direction_error) noexcept {
  if (facet != kNone) return true;
  const RecessionCone& cone = s.body().recession_cone;
  const Vec3 m = s.direction_A_to_L(normal);
  return cone.line_count == 0 && std::ranges::all_of(cone.rays, [&](const Vec3& ray) {
           return m.dot(ray) < -(kDerivativeError + direction_error);
         });
}

}  // namespace

Separators separators(const ActiveFeature& a, const ActiveFeature& b) noexcept {
  Separators list;
  const Vec3 between = b.point_A() - a.point_A();
  add_facets(list, a, b);
  // Rounding leaves a part of `between` along the active edges, which projections across them take
  // off. The edges are not at right angles to each other. So the projection across the second edge
  // brings back a part along the first one, which is then projected once more.
  Vec3 direct = between;
  if (a.feature() == FeatureKind::kEdge) direct = across(direct, along(a));
  if (b.feature() == FeatureKind::kEdge) direct = across(direct, along(b));
  if (a.feature() == FeatureKind::kEdge) direct = across(direct, along(a));
  add_direction(list, direct);
  // This direction is better only if the points are so near to each other that rounding affects
  // `direct`.
  if (a.feature() == FeatureKind::kEdge && b.feature() == FeatureKind::kEdge) {
    add_crossing_edges(list, a, b, between);
  }
  return list;
}

double separation(const Separator& s, const ActiveFeature& a, const ActiveFeature& b,
                  const Precision& p) noexcept {
  if (!a.body().bounded() && !b.body().bounded()) {
    const double error = b.pose()->rotation_error;
    const bool ends = ends_along(a, s.normal, s.facet_of_a, error) &&
                      ends_along(b, -s.normal, s.facet_of_b, error);
    if (!ends) return -kInfinity;
  }
  assert(is_unit_or_unknown(s.normal));
  const double value_a = support_value(a, s.normal, s.facet_of_a, p.extent_a);
  const double value_b = support_value(b, -s.normal, s.facet_of_b, p.extent_b);
  // The least n.x over B minus the greatest over A, each from the origin of its body's frame.
  const Vec3 origin_of_b = b.point_to_a(Vec3::Zero());
  return (s.normal.dot(origin_of_b) - value_b) - value_a;
}

}  // namespace clearance
