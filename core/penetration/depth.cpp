#include "core/penetration/depth.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/active_set/separating_direction.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/penetration/normal_search.hpp"

namespace clearance {
namespace {

// Errors that Precision::error_bound does not count, in multiples of Precision::size. A direction
// may miss its arc by 6 roundings, and a vertex may miss its plane by 6.
constexpr double kOnArc = 12 * kUlp;
// Two bounds of h that differ by no more than this count as equal, in multiples of Precision::size.
constexpr double kGapTolerance = 8 * kUlp;

using Source = NormalSearch::Source;

// If the best direction is exactly a facet's normal, the certificate may use the facet.
Separator separator(const MinkowskiDifference& body, const NormalSearch::Best& best,
                    const ActiveFeature& a, const ActiveFeature& b) noexcept {
  if (best.source != Source::kFacetOfX && best.source != Source::kFacetOfY) {
    return {body.to_a(best.n).normalized()};
  }
  const bool is_facet_of_b = (best.source == Source::kFacetOfX) == body.x_is_b();
  if (!is_facet_of_b) return {a.body().facets[best.facet].normal, best.facet, kNone};
  const Vec3& normal = b.body().facets[best.facet].normal;
  return {-b.direction_to_a(normal).normalized(), kNone, best.facet};
}

// The precision of heights, for distance 0. The vertices are the bodies' `anchors`, and even for an
// unbounded body only these count.
Precision precision_of_vertices(const ConvexBody& a, const ConvexBody& b,
                                const RelativePose& a_from_b) noexcept {
  Precision p = precision(a, b, a_from_b, 0.0);
  const double excess_a = p.extent_a - a.bounding_radius, excess_b = p.extent_b - b.bounding_radius;
  p.size -= excess_a + excess_b;
  p.error_bound -= kUlp * (kUlpsOnA * excess_a + kUlpsOnB * excess_b);
  return p;
}

// m: the error of a height that the search has found.
double rounding_of_height(const RelativePose& a_from_b, const Precision& p,
                          double height) noexcept {
  // A wrong rotation scales the depth here (see Precision), up to B's extent.
  const double translation = a_from_b.translation.norm();
  const double scaled = std::clamp(p.extent_b - p.extent_a - translation, 0.0, std::abs(height));
  return kOnArc * p.size + p.error_bound + a_from_b.rotation_error * scaled;
}

// The certified distance along `s` that separates the bodies. At a facet of X, or on the arc of an
// edge of X, the support value of X is exactly that of the feature. If the result is too far from
// `lower`, the lower bound of the depth, every ulp counts: both methods are tried.
double upper_bound_of(const NormalSearch::Best& best, const Separator& s, const ActiveFeature& a,
                      const ActiveFeature& b, const Precision& p, double rounding,
                      double lower) noexcept {
  const bool feature_of_x = best.source == Source::kFacetOfX || best.source == Source::kArc;
  const double by_feature = feature_of_x ? best.height + rounding : kInfinity;
  if (by_feature - lower <= kConvergedGap * p.size) return by_feature;
  return std::min(by_feature, -separation(s, a, b, p) + p.error_bound);
}

// The distance of a matrix from the nearest rotation (2-norm), rounding included.
double off_rotation(const Mat3& r) noexcept {
  return 0.5 * (r.transpose() * r - Mat3::Identity()).norm() + 8 * kUlp;
}

// Depth::lower from the least h that the search has found anywhere.
double depth_from_below(const ActiveFeature& a, const ActiveFeature& b,
                        const RelativePose& a_from_b, const Precision& p, double least) noexcept {
  const double rounding = rounding_of_height(a_from_b, p, least);
  if (least > rounding) return least - rounding;
  // B can be placed by the rotation that is nearest to the doubles of the pose, with less rounding.
  // If the bodies penetrate there, this bounds the depth as well: B's own place is no farther away
  // than the doubles are off that rotation and off the exact one.
  RelativePose placed = a_from_b;
  const double off = off_rotation(a_from_b.rotation);
  placed.rotation_error = off;
  placed.translation_error = 0.0;
  const Precision there = precision_of_vertices(a.body(), b.body(), placed);
  if (!(least > rounding_of_height(placed, there, least))) return -kInfinity;
  return least - rounding - 2.0 * off * p.extent_b;
}

// Two points or segments have no inside: they meet in a point, and a minimal translation separates
// them.
Depth depth_of_segments(const ActiveFeature& a, const ActiveFeature& b,
                        const Precision& p) noexcept {
  const auto along = [](const ActiveFeature& s) {
    return s.body().edges.empty() ? Vec3::Zero().eval()
                                  : s.direction_to_a(s.body().edges[0].direction);
  };
  const Vec3 n = direction_case::across_both(along(a), along(b));
  const double forth = separation({n}, a, b, p), back = separation({-n}, a, b, p);
  Depth out;
  out.normal = forth >= back ? n : Vec3(-n);
  out.value = -std::max(forth, back);
  out.upper = out.value + p.error_bound;
  return out;
}

}  // namespace

Depth depth(const ActiveFeature& a, const ActiveFeature& b, const RelativePose& a_from_b,
            const Separator& guess) noexcept {
  assert(a_from_b.rotation.allFinite() && a_from_b.translation.allFinite());
  const Precision start = precision_of_vertices(a.body(), b.body(), a_from_b);
  if (a.body().facets.empty() && b.body().facets.empty()) return depth_of_segments(a, b, start);
  const MinkowskiDifference body(a.body(), b.body(), a_from_b);
  Depth out;
  if (!body.y().bounded()) return out;  // two unbounded bodies: nothing is known
  NormalSearch search(body, kGapTolerance * start.size, a_from_b.rotation_error + kDerivativeError);
  const std::int32_t of_x = body.x_is_b() ? guess.facet_of_b : guess.facet_of_a;
  const std::int32_t of_y = body.x_is_b() ? guess.facet_of_a : guess.facet_of_b;
  if (of_x != kNone) {
    search.guess_facet_of_x(of_x);
  } else if (of_y != kNone) {
    search.guess_facet_of_y(of_y);
  } else {
    const std::int32_t edge_of_x = body.x_is_b() ? guess.edge_of_b : guess.edge_of_a;
    search.guess(body.from_a(guess.normal), edge_of_x);
  }
  if (!search.ended_early()) search.run();

  const NormalSearch::Best& best = search.best();
  const Precision p = precision(a.body(), b.body(), a_from_b, std::abs(best.height));
  const Separator s = separator(body, best, a, b);
  out.normal = s.normal;
  out.facet_of_a = s.facet_of_a;
  out.facet_of_b = s.facet_of_b;
  if (!search.ended_early()) {
    out.lower = depth_from_below(a, b, a_from_b, start, std::min(search.lower(), best.height));
  }
  out.upper =
      upper_bound_of(best, s, a, b, p, rounding_of_height(a_from_b, start, best.height), out.lower);
  out.value = best.source == Source::kGuess ? out.upper - p.error_bound : best.height;
  assert(out.lower <= out.upper && is_unit_or_unknown(out.normal));
  return out;
}

}  // namespace clearance
