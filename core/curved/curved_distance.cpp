#include "core/curved/curved_distance.hpp"

#include <algorithm>
#include <cmath>

#include "core/curved/depth.hpp"
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

// `depth`: the bodies' cores overlap by at least this, where that is known; m.
DistanceResult conclude(const CurvedPair& pair, double depth) noexcept {
  const CurvedBounds& bounds = pair.bounds;
  const double error = pair.error(), radii = pair.a.body->radius + pair.b.body->radius;
  const double upper = std::min(bounds.upper, -depth);
  const double rounding = 0x1p-52 * (radii + std::abs(upper));
  DistanceResult r;
  r.normal = bounds.normal;
  r.lower = (bounds.lower - error) - radii - rounding;
  r.upper = (upper + error) - radii + rounding;
  const double best = bounds.lower < 0.0 ? bounds.lower : bounds.upper;
  r.distance = std::clamp(best - radii, r.lower, r.upper);
  r.point_on_a = bounds.points.a + pair.a.body->radius * r.normal;
  r.point_on_b = bounds.points.b - pair.b.body->radius * r.normal;
  const bool converged = r.upper - r.lower <= kConvergedCurvedGap * (pair.size + radii);
  r.status = !converged        ? DistanceStatus::kIterationLimit
             : r.lower > 0.0   ? DistanceStatus::kConverged
             : r.upper < 0.0   ? DistanceStatus::kOverlapping
                               : DistanceStatus::kTouching;
  return r;
}

}  // namespace

DistanceResult curved_distance(const CurvedBody& a, const CurvedBody& b,
                               const RelativePose& a_from_b, CurvedTrackingState& state) noexcept {
  CurvedPair pair(a, b, a_from_b);
  if (!is_usable(state, a, b)) state = {};
  int supports = 0;
  if (!state.normal.isZero()) {
    supports += search_direction(pair, state.normal, state.active).supports;
  }
  if (!pair.is_tight()) {
    state.active = {};
    const CurvedStart start = start_direction(pair);
    if (!start.meet) supports += search_direction(pair, start.normal, state.active).supports;
  }
  double depth = -kInfinity;
  if (!pair.is_tight() && pair.bounds.lower < 0.0) {
    const DepthBounds found = bound_depth(pair);
    depth = found.lower;
    supports += found.supports;
  }
  state.normal = pair.bounds.normal;
  DistanceResult r = conclude(pair, depth);
  r.iterations = static_cast<std::uint16_t>(supports);
  return r;
}

}  // namespace clearance
