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

// A unit vector or its product with another, rounding included: 2^-52 and three roundings each.
constexpr double kRounding = 0x1p-50;

// How far from level a body's level line is, seen along n, or a bundle from falling; at most, its
// own error included.
double off_level(const LevelRays& rays, const ActiveSide& s, const Vec3& line,
                 const Vec3& n) noexcept {
  if (rays.directions == 0) return 0.0;
  return std::abs(line.dot(n)) + rays.spread + kRounding + s.direction_error();
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
  // One level line or bundle each: the direction across both is near n, and turns no other ray
  // upwards. What n has to be moved by, within the plane of the lines, has their products with n;
  // 2^-30 is for the rounding of the sine, of which no less than 2^-10 passes, and for squares of
  // the tilt.
  const Vec3 line_a = a.direction_to_common(of_a.direction);
  const Vec3 line_b = b.direction_to_common(of_b.direction);
  const double sine = of_a.directions + of_b.directions < 2 ? 1.0 : line_a.cross(line_b).norm();
  const double tilt =
      (1.0 + 0x1p-30) * (off_level(of_a, a, line_a, n) + off_level(of_b, b, line_b, n)) / sine;
  return tilt < 0x1p-40 - kRounding ? tilt : kInfinity;
}

// Against the exact normal of a facet its own body's rays are level or fall, whatever rounding
// says: it is a proof when the other body's rays certainly fall away. n: the normal in the common
// frame.
double tilt_to_facet_proof(const Vec3& n, const ActiveSide& own, const ActiveSide& other) noexcept {
  const double tilt = 0x1p-52 + own.direction_error();
  const double margin = 0x1p-40 + kRounding + own.direction_error() + other.direction_error();
  const bool falls =
      level_rays(other.body(), other.direction_to_own(Vec3(-n)), margin).directions == 0;
  return falls ? tilt : kInfinity;
}

// How far a body's anchors are from one of them, at most.
double spread(const ConvexPolyhedron& body, const Vec3& from) noexcept {
  double out = 0.0;
  for (const Vec3& anchor : body.anchors) out = std::max(out, (anchor - from).norm());
  return out;
}

double separation_of_unbounded(const Separator& s, const ActiveSide& a,
                               const ActiveSide& b) noexcept {
  const Vec3& n = s.normal;
  double tilt = tilt_to_proof(n, a, b);
  if (s.facet_of_a != kNone) tilt = std::min(tilt, tilt_to_facet_proof(n, a, b));
  if (s.facet_of_b != kNone) tilt = std::min(tilt, tilt_to_facet_proof(-n, b, a));
  if (!(tilt < kInfinity)) return -kInfinity;
  const Vec3& on_a = a.body().anchors[support(a.body(), n).anchor];
  const Vec3& on_b = b.body().anchors[support(b.body(), -b.direction_to_own(n)).anchor];
  const Vec3 between = b.point_to_common(on_b) - on_a;
  const double origins = b.point_to_common(Vec3::Zero()).norm();
  const double moved = std::min(between.norm() + spread(a.body(), on_a) + spread(b.body(), on_b),
                                a.body().bounding_radius + b.body().bounding_radius + origins);
  return n.dot(between) - tilt * moved;
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
