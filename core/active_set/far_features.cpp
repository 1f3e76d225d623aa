#include "core/active_set/far_features.hpp"

#include <algorithm>
#include <cmath>

#include "core/active_set/polar_cone.hpp"
#include "core/active_set/separating_direction.hpp"

namespace clearance {
namespace {

// Is where a point lies along its edge, m, certainly between the ends, off by this or not?
bool is_between_ends(const ActiveFeature& side, double off) noexcept {
  const double at = (side.own() - side.edge().point).dot(side.edge().direction);
  return at - off > side.edge().begin && at + off < side.edge().end;
}

FarApart across_edges(const ActiveFeature& a, const ActiveFeature& b, const Precision& p) noexcept {
  const double sine = towards_case::along(a).cross(towards_case::along(b)).norm();
  // Beyond this a wrong rotation moves the closest points by more than a part of the way to them.
  if (!(sine > 0x1p-42)) return {};
  const double out = a.own().norm() + b.own().norm();
  const double off = 0x1p-3 * out + 0x1p-46 * p.size / sine;
  if (!is_between_ends(a, off) || !is_between_ends(b, off)) return {};
  const auto across = PolarCone(a, b).across_lines(a.edge(), b.edge());
  if (!(across.off < kInfinity)) return {};
  const Vec3 between = b.point_to_common(b.edge().point) - a.edge().point;
  return {std::abs(across.n.dot(between)), across.off * between.norm()};
}

// Parts of an edge, m along it.
struct Stretch {
  double from, to;

  // Where level + rate s >= 0.
  void clip(double level, double rate) noexcept {
    if (rate > 0.0) {
      from = std::max(from, -level / rate);
    } else if (rate < 0.0) {
      to = std::min(to, -level / rate);
    } else if (level < 0.0) {
      to = -kInfinity;
    }
  }
};

// A point of the edge, placed over the facet, is off by less than this part of the bodies' size and
// of how far along the edge it lies: by 25 ulps for the rotation, by less than 30 for all else.
constexpr double kOverFacet = 0x1p-46;

// Where an edge is over a facet for certain.
Stretch over_facet(const ActiveFeature& edge, const ActiveFeature& facet, double size) noexcept {
  const auto point = [&](const Vec3& own) {
    const Vec3 common = edge.point_to_common(own);
    return facet.pose() ? Vec3(facet.direction_to_own(common - facet.pose()->translation)) : common;
  };
  const Vec3 from = point(edge.edge().point);
  const Vec3 way = facet.direction_to_own(edge.direction_to_common(edge.edge().direction));
  Stretch out{edge.edge().begin, edge.edge().end};
  for (std::int32_t i = 0; i < facet.facet().limits; ++i) {
    const FacetLimit limit = facet.body().limit_of(facet.facet(), i);
    const double level = limit.inward.dot(from) - limit.offset - kOverFacet * size;
    const double rate = limit.inward.dot(way);
    out.clip(level, rate - kOverFacet);
    out.clip(level, rate + kOverFacet);
  }
  return out;
}

// Over the facet the edge is the nearest at one of the stretch's ends, wherever that may be.
FarApart from_facet(const PolarCone& cone, const ActiveFeature& edge, const ActiveFeature& facet,
                    const Precision& p) noexcept {
  const Stretch over = over_facet(edge, facet, p.size);
  const bool of_b = facet.pose() != nullptr;
  const auto slope = cone.slope_over_facet(of_b, facet.index(), edge.edge());
  if (!(over.from <= over.to) || !(slope.error < kInfinity)) return {};
  const auto [n, off] = cone.of_facet(of_b, facet.index());
  const Vec3 between = edge.point_to_common(edge.edge().point) -
                       facet.point_to_common(facet.body().point_of(facet.facet()));
  const double at_point = n.dot(between);
  FarApart out;
  for (const double s : {over.from, over.to, std::clamp(0.0, over.from, over.to)}) {
    if (!(std::abs(s) < kInfinity)) continue;
    const double rise = s * slope.rate, upper = std::abs(at_point + rise);
    const double beyond =
        off * between.norm() + slope.error * std::abs(s) + 0x1p-50 * std::abs(rise);
    if (upper + beyond < out.upper + out.beyond) out = {upper, beyond};
  }
  return out;
}

}  // namespace

FarApart far_apart(const ActiveFeature& a, const ActiveFeature& b, const Precision& p) noexcept {
  const auto are = [&](FeatureKind of_a, FeatureKind of_b) {
    return a.feature() == of_a && b.feature() == of_b;
  };
  if (are(FeatureKind::kEdge, FeatureKind::kEdge)) return across_edges(a, b, p);
  if (are(FeatureKind::kEdge, FeatureKind::kFacet)) return from_facet(PolarCone(a, b), a, b, p);
  if (are(FeatureKind::kFacet, FeatureKind::kEdge)) return from_facet(PolarCone(a, b), b, a, p);
  return {};
}

}  // namespace clearance
