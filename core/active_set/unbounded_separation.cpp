#include "core/active_set/unbounded_separation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/model/support_function.hpp"
#include "core/numerics/double_double.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// Of a facet's normal: rounded to 2^-53 in each component, and once more where it is turned.
constexpr double kFacetError = 0x1p-51;

// Of the direction across two unit vectors, one of them turned, times the sine of their angle; and
// what normalising it adds.
constexpr double kAcrossError = 0x1p-49, kUnitError = 0x1p-51;
// No direction is worth trying that is known no better.
constexpr double kMostOff = 0x1p-20;

// Products smaller than this, in magnitude, may have lost digits.
constexpr double kLeastProduct = 0x1p-900;

// A unit vector, common frame, and how far from it, as an angle, there certainly is a direction
// along which neither body is unbounded.
struct Direction {
  Vec3 n;
  double off;
};
constexpr double kUnknown = kInfinity;

// Do the three products add up to 0 or less, for certain?
bool falls_or_is_level(const Vec3& n, const Vec3& g) noexcept {
  std::array<double, 6> parts{};
  for (int i = 0; i < 3; ++i) {
    if (n[i] == 0.0 || g[i] == 0.0) continue;
    const DoubleDouble p = exact::product(n[i], g[i]);
    if (!(std::abs(p.high) > kLeastProduct)) return false;
    parts[static_cast<std::size_t>(2 * i)] = p.low;
    parts[static_cast<std::size_t>(2 * i + 1)] = p.high;
  }
  return exact::sum_is_not_positive(parts);
}

// Does no ray rise along m, which is off by `error`? `exact_m`: m itself up to a factor, zero where
// that is not known; all in the body's frame.
bool none_rises(const ConvexPolyhedron& body, const Vec3& m, double error,
                const Vec3& exact_m) noexcept {
  return std::ranges::all_of(body.rays, [&](const Ray& ray) {
    const double rate = m.dot(ray.direction) / ray.direction.norm();
    if (rate < -(kDerivativeError + error)) return true;
    return ray.exact && !exact_m.isZero(0.0) && falls_or_is_level(exact_m, ray.direction);
  });
}

// A facet's outward normal as far as it is exactly three doubles, or zero.
Vec3 exact_normal(const ActiveFeature& s, std::int32_t facet) noexcept {
  return s.body().exact_normals[static_cast<std::size_t>(facet)];
}

Direction as_it_is(const Separator& s, const ActiveFeature& a, const ActiveFeature& b) noexcept {
  const double turned = b.pose()->rotation_error;
  const bool of_a = s.facet_of_a != kNone, of_b = s.facet_of_b != kNone;
  const Vec3 exact_n = of_a   ? exact_normal(a, s.facet_of_a)
                       : of_b ? Vec3(-b.direction_to_common(exact_normal(b, s.facet_of_b)))
                              : s.normal;
  const Vec3 known = turned == 0.0 ? exact_n : Vec3(Vec3::Zero());
  const Vec3 known_to_a = of_b ? known : exact_n;
  const double error = of_a || of_b ? kFacetError + turned : turned;
  const bool falls = (of_a || none_rises(a.body(), s.normal, error, known_to_a)) &&
                     (of_b || none_rises(b.body(), -b.direction_to_own(s.normal), error,
                                         Vec3(-b.direction_to_own(known))));
  if (!falls) return {s.normal, kUnknown};
  return {s.normal, of_a ? kFacetError : of_b ? error : 0.0};
}

// Of bodies with one line each that cross: across both, on the side of s.
Direction across_lines(const Separator& s, const ActiveFeature& a,
                       const ActiveFeature& b) noexcept {
  const RecessionCone &of_a = a.body().recession_cone, &of_b = b.body().recession_cone;
  if (of_a.line_count != 1 || of_b.line_count != 1) return {s.normal, kUnknown};
  const Vec3 across = of_a.lines[0].cross(b.direction_to_common(of_b.lines[0]));
  const double sine = across.norm();
  const double off = (kAcrossError + b.pose()->rotation_error) / sine + kUnitError;
  if (!(off < kMostOff)) return {s.normal, kUnknown};
  const Vec3 n = across / (across.dot(s.normal) < 0.0 ? -sine : sine);
  const auto fall = [&](const RecessionCone& opening, const Vec3& m, double error) {
    return std::ranges::all_of(
        opening.rays, [&](const Vec3& ray) { return m.dot(ray) < -(kDerivativeError + error); });
  };
  const bool falls =
      fall(of_a, n, off) && fall(of_b, -b.direction_to_own(n), off + b.pose()->rotation_error);
  return {n, falls ? off : kUnknown};
}

// How far a body's anchors are from one of them, at most.
double spread(const ConvexPolyhedron& body, const Vec3& from) noexcept {
  double out = 0.0;
  for (const Vec3& anchor : body.anchors) out = std::max(out, (anchor - from).norm());
  return out;
}

}  // namespace

double separation_of_unbounded(const Separator& s, const ActiveFeature& a,
                               const ActiveFeature& b) noexcept {
  Direction known = as_it_is(s, a, b);
  if (known.off == kUnknown) known = across_lines(s, a, b);
  const auto& [n, off] = known;
  if (off == kUnknown) return -kInfinity;
  const Vec3& on_a = a.body().anchors[support(a.body(), n).anchor];
  const Vec3& on_b = b.body().anchors[support(b.body(), -b.direction_to_own(n)).anchor];
  const Vec3 between = b.point_to_common(on_b) - on_a;
  const double origins = b.point_to_common(Vec3::Zero()).norm();
  const double moved = std::min(between.norm() + spread(a.body(), on_a) + spread(b.body(), on_b),
                                a.body().bounding_radius + b.body().bounding_radius + origins);
  return n.dot(between) - off * moved;
}

}  // namespace clearance
