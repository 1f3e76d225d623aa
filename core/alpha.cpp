#include "core/alpha.hpp"

namespace clearance {
namespace {

// Distance to a boundary over the speed towards it; a boundary that rounding has let us cross
// blocks at once.
double fraction(double gap, double speed) noexcept { return gap > 0.0 ? gap / speed : 0.0; }

Alpha from_inside(const ActiveSide& side, const Vec3& move) noexcept {
  Alpha best;
  const auto& facets = side.body().facets;
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const double speed = facets[i].normal.dot(move);
    if (!(speed > 0.0)) continue;
    const double f = fraction(facets[i].offset - facets[i].normal.dot(side.own()), speed);
    if (f < best.fraction) best = {f, static_cast<std::int32_t>(i)};
  }
  return best;
}

Alpha within_facet(const ActiveSide& side, const Vec3& move) noexcept {
  Alpha best;
  const Facet& facet = side.facet();
  for (std::int32_t i = 0; i < facet.sides; ++i) {
    const EdgeUse& use = side.body().facet_edges[facet.first_side + i];
    const Edge& edge = side.body().edges[use.edge];
    const double speed = -edge.inward[use.side].dot(move);
    if (!(speed > 0.0)) continue;
    const double f = fraction((side.own() - edge.point).dot(edge.inward[use.side]), speed);
    if (f < best.fraction) best = {f, use.edge};
  }
  return best;
}

Alpha along_edge(const ActiveSide& side, const Vec3& move) noexcept {
  const Edge& edge = side.edge();
  const double speed = edge.direction.dot(move);
  const double at = (side.own() - edge.point).dot(edge.direction);
  Alpha step;
  if (speed > 0.0 && edge.vertex[1] != kNone) {
    step = {fraction(edge.end - at, speed), edge.vertex[1]};
  } else if (speed < 0.0 && edge.vertex[0] != kNone) {
    step = {fraction(at - edge.begin, -speed), edge.vertex[0]};
  }
  return step.fraction < 1.0 ? step : Alpha{};
}

}  // namespace

Alpha alpha(const ActiveSide& side, const Vec3& move_in_common) noexcept {
  if (side.feature() == Feature::kVertex) return {};
  const Vec3 move = side.direction_to_own(move_in_common);
  if (side.feature() == Feature::kEdge) return along_edge(side, move);
  if (side.feature() == Feature::kFacet) return within_facet(side, move);
  return from_inside(side, move);
}

void advance(ActiveSide& side, const Vec3& move_in_common, const Alpha& step) noexcept {
  if (side.feature() == Feature::kVertex) return;
  const Vec3 to = side.own() + step.fraction * side.direction_to_own(move_in_common);
  if (side.feature() == Feature::kEdge) {
    if (step.blocking != kNone) return side.place_at_vertex(step.blocking);
    return side.place_on_edge(side.index(), to);
  }
  if (side.feature() == Feature::kFacet) {
    if (step.blocking != kNone) return side.place_on_edge(step.blocking, to);
    return side.place_on_facet(side.index(), to);
  }
  if (step.blocking != kNone) return side.place_on_facet(step.blocking, to);
  side.place_inside(to);
}

}  // namespace clearance
