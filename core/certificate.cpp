#include "core/certificate.hpp"

#include <cmath>

#include "core/support.hpp"

namespace clearance {
namespace {

// A separating direction shorter than this (as a cross product of unit vectors) says nothing of its
// own.
constexpr double kTooParallel = 1e-6;

Vec3 edge_direction(const ActiveSide& s) noexcept {
  return s.direction_to_common(s.edge().direction);
}

Vec3 across(const Vec3& v, const Vec3& e) noexcept { return v - v.dot(e) * e; }

void add_direction(Separators& list, const Vec3& v) noexcept {
  const double length = v.norm();
  if (length > 0.0 && std::isfinite(length)) list.add({v / length});
}

void add_facets(Separators& list, const ActiveSide& a, const ActiveSide& b) noexcept {
  if (a.feature() == Feature::kFacet) list.add({a.facet().normal, a.index(), kNone});
  if (b.feature() == Feature::kFacet) {
    list.add({-b.direction_to_common(b.facet().normal), kNone, b.index()});
  }
}

void add_crossing_edges(Separators& list, const ActiveSide& a, const ActiveSide& b,
                        const Vec3& between) noexcept {
  const Vec3 e = edge_direction(a);
  const Vec3 f = across(edge_direction(b), e);
  const double sine = f.norm();
  if (sine > kTooParallel) {
    const Vec3 n = e.cross(across(Vec3(f / sine), e));
    add_direction(list, n.dot(between) < 0.0 ? Vec3(-n) : n);
  }
}

// The anchor from which to look for the farthest one.
std::int32_t start(const ActiveSide& s) noexcept {
  if (s.feature() == Feature::kVertex) return s.index();
  std::int32_t edge = kNone;
  if (s.feature() == Feature::kEdge) edge = s.index();
  if (s.feature() == Feature::kFacet && s.facet().sides > 0) {
    edge = s.body().facet_edges[s.facet().first_side].edge;
  }
  if (edge == kNone) return 0;
  const Edge& e = s.body().edges[edge];
  return std::max(0, e.vertex[0] != kNone ? e.vertex[0] : e.vertex[1]);
}

double reach(const ActiveSide& s, const Vec3& normal, std::int32_t facet, double within,
             bool other_bounded) noexcept {
  const bool both_unbounded = !s.body().bounded() && !other_bounded;
  if (facet != kNone && !both_unbounded) return s.body().facets[facet].offset;
  const Vec3 m = s.direction_to_own(normal);
  const double anchors = support(s.body(), m, start(s)).reach;
  if (s.body().bounded()) return anchors;
  if (both_unbounded)
    return rays_stay_below(s.body(), m, s.direction_error()) ? anchors : kInfinity;
  return anchors + reach_along_rays(s.body(), m, within);
}

}  // namespace

Separators separators(const ActiveSide& a, const ActiveSide& b) noexcept {
  Separators list;
  const Vec3 between = b.common() - a.common();
  add_facets(list, a, b);
  if (a.feature() == Feature::kEdge && b.feature() == Feature::kEdge) {
    add_crossing_edges(list, a, b, between);
  }
  Vec3 direct = between;
  if (a.feature() == Feature::kEdge) direct = across(direct, edge_direction(a));
  if (b.feature() == Feature::kEdge) direct = across(direct, edge_direction(b));
  if (a.feature() == Feature::kEdge) direct = across(direct, edge_direction(a));
  add_direction(list, direct);
  return list;
}

double separation(const Separator& s, const ActiveSide& a, const ActiveSide& b,
                  const Precision& p) noexcept {
  const double of_a = reach(a, s.normal, s.facet_of_a, p.reach_a, b.body().bounded());
  const double of_b = reach(b, Vec3(-s.normal), s.facet_of_b, p.reach_b, a.body().bounded());
  const Vec3 origin_of_b = b.point_to_common(Vec3::Zero());
  return (s.normal.dot(origin_of_b) - of_b) - of_a;
}

}  // namespace clearance
