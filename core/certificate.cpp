#include "core/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "core/support.hpp"
#include "core/towards.hpp"

namespace clearance {
namespace {

using towards_case::across;
using towards_case::along;

// A separating direction shorter than this (as a cross product of unit vectors) says nothing of its
// own.
constexpr double kTooParallel = 1e-6;

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
  const Vec3 e = along(a);
  const Vec3 f = across(along(b), e);
  const double sine = f.norm();
  if (sine > kTooParallel) {
    const Vec3 n = e.cross(across(Vec3(f / sine), e));
    add_direction(list, n.dot(between) < 0.0 ? Vec3(-n) : n);
  }
}

double reach(const ActiveSide& s, const Vec3& normal, std::int32_t facet, double within) noexcept {
  if (facet != kNone) return s.body().facets[facet].offset;
  const Vec3 m = s.direction_to_own(normal);
  return support(s.body(), m).reach + reach_along_rays(s.body(), m, within);
}

// Two unbounded bodies are apart only if some direction has both bodies' rays falling away or
// standing exactly across it. How far from `n` (an angle) there certainly is one; infinity: none is
// known.
double tilt_to_proof(const Vec3& n, const ActiveSide& a, const ActiveSide& b) noexcept {
  const double margin = 0x1p-40 + a.direction_error() + b.direction_error();
  const LevelRays of_a = level_rays(a.body(), a.direction_to_own(n), margin);
  const LevelRays of_b = level_rays(b.body(), -b.direction_to_own(n), margin);
  const bool exact = a.direction_error() == 0.0 && b.direction_error() == 0.0;
  if (exact && of_a.exactly_level && of_b.exactly_level) return 0.0;
  if (of_a.directions > 1 || of_b.directions > 1) return kInfinity;
  // One level line each: the direction across both is near n, and turns no other ray upwards.
  const Vec3 line_a = a.direction_to_common(of_a.direction);
  const Vec3 line_b = b.direction_to_common(of_b.direction);
  const double sine = of_a.directions + of_b.directions < 2 ? 1.0 : line_a.cross(line_b).norm();
  const double rounding = 0x1p-50 + a.direction_error() + b.direction_error();
  const double tilt =
      2.0 * (std::abs(line_a.dot(n)) + std::abs(line_b.dot(n)) + 2.0 * rounding) / sine;
  return tilt < margin - rounding ? tilt : kInfinity;
}

// Against the exact normal of a facet its own body's rays are level or fall, whatever rounding
// says: it is a proof when the other body's rays certainly fall away.
double tilt_to_facet_proof(const Vec3& n, const ActiveSide& other,
                           double direction_error) noexcept {
  const double rounding = 0x1p-50 + direction_error;
  const bool falls =
      level_rays(other.body(), other.direction_to_own(n), 0x1p-40 + rounding).directions == 0;
  return falls ? 2.0 * rounding : kInfinity;
}

double separation_of_unbounded(const Separator& s, const ActiveSide& a,
                               const ActiveSide& b) noexcept {
  const Vec3& n = s.normal;
  const double error = a.direction_error() + b.direction_error();
  double tilt = tilt_to_proof(n, a, b);
  if (s.facet_of_a != kNone) tilt = std::min(tilt, tilt_to_facet_proof(-n, b, error));
  if (s.facet_of_b != kNone) tilt = std::min(tilt, tilt_to_facet_proof(n, a, error));
  if (!(tilt < kInfinity)) return -kInfinity;
  const double of_a = support(a.body(), n).reach;
  const double of_b = support(b.body(), -b.direction_to_own(n)).reach;
  const Vec3 origin_of_b = b.point_to_common(Vec3::Zero());
  const double moved = a.body().bounding_radius + b.body().bounding_radius + origin_of_b.norm();
  return (n.dot(origin_of_b) - of_b) - of_a - tilt * moved;
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
  if (a.feature() == Feature::kEdge) direct = across(direct, along(a));
  if (b.feature() == Feature::kEdge) direct = across(direct, along(b));
  if (a.feature() == Feature::kEdge) direct = across(direct, along(a));
  add_direction(list, direct);
  return list;
}

double separation(const Separator& s, const ActiveSide& a, const ActiveSide& b,
                  const Precision& p) noexcept {
  if (!a.body().bounded() && !b.body().bounded()) return separation_of_unbounded(s, a, b);
  const double of_a = reach(a, s.normal, s.facet_of_a, p.reach_a);
  const double of_b = reach(b, -s.normal, s.facet_of_b, p.reach_b);
  const Vec3 origin_of_b = b.point_to_common(Vec3::Zero());
  return (s.normal.dot(origin_of_b) - of_b) - of_a;
}

}  // namespace clearance
