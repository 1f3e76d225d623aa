#include "core/curved/curved_distance.hpp"

#include <algorithm>
#include <cmath>

#include "core/curved/start.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// Bounds of bodies that have converged are within this of each other, by the pair's size.
constexpr double kConvergedCurvedGap = 1e-13;

bool is_usable(const CurvedTrackingState& state, const CurvedBody& a,
               const CurvedBody& b) noexcept {
  const double square = state.normal.squaredNorm();
  if (!(std::abs(square - 1.0) < 1e-9) || state.active.count > 3) return false;
  const auto pieces = [](const CurvedBody& body) {
    if (body.kind == CurvedBody::Kind::kPolyhedron) {
      return static_cast<std::int32_t>(body.polyhedron->anchors.size());
    }
    return body.kind == CurvedBody::Kind::kEllipsoid ? 1 : 2;
  };
  for (std::size_t i = 0; i < state.active.count; ++i) {
    const PiecePair& pair = state.active.pieces[i];
    if (pair.a < 0 || pair.b < 0 || pair.a >= pieces(a) || pair.b >= pieces(b)) return false;
  }
  return true;
}

DistanceResult conclude(const CurvedPair& pair, bool meet) noexcept {
  const CurvedBounds& bounds = pair.bounds;
  const double error = pair.error(), radii = pair.a.body->radius + pair.b.body->radius;
  const double rounding = 0x1p-52 * (radii + std::abs(bounds.upper));
  DistanceResult r;
  r.normal = bounds.normal;
  r.lower = (bounds.lower - error) - radii - rounding;
  r.upper = ((meet ? 0.0 : bounds.upper) + error) - radii + rounding;
  r.distance = std::clamp((meet ? bounds.lower : bounds.upper) - radii, r.lower, r.upper);
  r.point_on_a = bounds.points.a + pair.a.body->radius * r.normal;
  r.point_on_b = bounds.points.b - pair.b.body->radius * r.normal;
  const bool converged = r.upper - r.lower <= kConvergedCurvedGap * (pair.size + radii);
  if (r.upper < 0.0) {
    r.status = DistanceStatus::kOverlapping;
  } else if (!(r.lower > 0.0)) {
    r.status = meet || converged ? DistanceStatus::kTouching : DistanceStatus::kIterationLimit;
  } else {
    r.status = converged ? DistanceStatus::kConverged : DistanceStatus::kIterationLimit;
  }
  return r;
}

}  // namespace

DistanceResult curved_distance(const CurvedBody& a, const CurvedBody& b,
                               const RelativePose& a_from_b, CurvedTrackingState& state) noexcept {
  CurvedPair pair(a, b, a_from_b);
  if (!is_usable(state, a, b)) state = {};
  CurvedStart start{state.normal};
  if (state.normal.isZero()) start = start_direction(pair);
  DirectionSearchEnd end;
  if (!start.meet) {
    end = search_direction(pair, start.normal, state.active);
    if (!pair.is_tight() && !state.normal.isZero()) {
      state = {};
      start = start_direction(pair);
      if (!start.meet) end = search_direction(pair, start.normal, state.active);
    }
  }
  state.normal = pair.bounds.normal;
  DistanceResult r = conclude(pair, start.meet);
  r.iterations = static_cast<std::uint16_t>(end.supports);
  return r;
}

}  // namespace clearance
