#include "core/active_set/dqp3.hpp"

#include <cassert>

#include "core/active_set/alpha_step_length.hpp"
#include "core/active_set/delta_step.hpp"
#include "core/active_set/lambda_multipliers.hpp"
#include "core/active_set/separating_direction.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// Far above the longest iteration of any hard case.
constexpr std::uint16_t kMostIterations = 1000;

// Some steps gain in exact arithmetic and not in doubles. They follow edges shorter than the
// rounding of their ends, for example where four planes nearly meet in a point. More such steps
// mean that rounding makes the iteration cycle.
constexpr int kStepsWithoutGain = 12;

// One step of both points towards `to`. Each moves as far as its own facets allow (§3.4.1). If that
// would increase the distance, both move by the smaller of the two fractions, which cannot increase
// it. True: nothing blocked.
bool step(ActiveFeature& a, ActiveFeature& b, const Delta& to) noexcept {
  const Vec3 move_a = to.a - a.point_A(), move_b = to.b - b.point_A();
  Alpha alpha_a = alpha(a, move_a), alpha_b = alpha(b, move_b);
  const bool free = alpha_a.blocking == kNone && alpha_b.blocking == kNone;
  if (!free) {
    const Vec3 between = b.point_A() - a.point_A();
    const Vec3 after = between + alpha_b.fraction * move_b - alpha_a.fraction * move_a;
    if (after.squaredNorm() > between.squaredNorm()) {
      if (alpha_a.fraction < alpha_b.fraction) {
        alpha_b = {alpha_a.fraction, kNone};
      } else if (alpha_b.fraction < alpha_a.fraction) {
        alpha_a = {alpha_b.fraction, kNone};
      }
    }
  }
  advance(a, move_a, alpha_a);
  advance(b, move_b, alpha_b);
  return free;
}

// Makes the feature that remains the active one, at the same point x.
void release(ActiveFeature& side, const Lambda& l) noexcept {
  side.place(l.to, l.index, side.point_L());
}

// Facets on the far side of a body may be parallel within rounding. There no edge and no facet
// comes closer, although a move through the inside does. This gain must exceed kThin of the body's
// size; otherwise rounding decides.
constexpr double kThin = 0x1p-44;

bool leave_for_inside(ActiveFeature& side, const Vec3& direction_in_a) noexcept {
  if (side.feature() == FeatureKind::kInside) return false;
  const ConvexBody& body = side.body();
  const Vec3 direction = side.direction_A_to_L(direction_in_a);
  const double thin = kThin * direction.norm();
  const bool closer =
      (body.interior - side.point_L()).dot(direction) > thin * body.bounding_radius ||
      body.recession_cone.inwards.dot(direction) > thin;
  if (closer) side.place_inside(side.point_L());
  return closer;
}

Dqp3Outcome iterate(ActiveFeature& a, ActiveFeature& b, double contact) noexcept {
  Dqp3Outcome outcome;
  const auto ended = [&](Dqp3End end) {
    outcome.end = end;
    return outcome;
  };
  double closest2 = kInfinity;
  int without_gain = 0;
  while (outcome.iterations < kMostIterations) {
    ++outcome.iterations;
    if (!step(a, b, delta(a, b))) continue;
    const SeparatingDirection found = separating_direction(a, b);
    const Vec3& direction = found.vector;
    outcome.separating_direction = direction;
    const double distance2 = (b.point_A() - a.point_A()).squaredNorm();
    if (distance2 <= contact * contact) return ended(Dqp3End::kContact);
    if (distance2 < closest2) {
      closest2 = distance2;
    } else if (++without_gain > kStepsWithoutGain) {
      return ended(Dqp3End::kStalled);
    }
    const Lambda release_a = lambda(a, direction), release_b = lambda(b, -direction);
    const double best = std::max(release_a.derivative, release_b.derivative);
    // Zero to rounding: degenerate, and neither sign of it is certified.
    if (best * best < kDerivativeError * kDerivativeError * distance2) {
      if (leave_for_inside(a, direction) || leave_for_inside(b, -direction)) continue;
      return ended(Dqp3End::kOptimal);
    }
    if (best < 0.0) return ended(found.exact ? Dqp3End::kCertified : Dqp3End::kOptimal);
    // Releases in the body that comes closer faster.
    if (release_a.derivative >= release_b.derivative) {
      release(a, release_a);
    } else {
      release(b, release_b);
    }
  }
  return outcome;
}

// At a sharp edge or vertex, a point may be past the edge by far more than it is outside either
// plane. A point is inside beyond rounding if its gap to every plane exceeds this share of a
// length. The length is the bounding radius plus the point's distance from the origin.
constexpr double kInsideBeyondRounding = 16 * kUlp;

// Moves a point to the nearest facet unless it is inside by more than rounding.
void leave_inside(ActiveFeature& side) noexcept {
  const ConvexBody& body = side.body();
  double least = kInsideBeyondRounding * (body.bounding_radius + side.point_L().norm());
  std::int32_t nearest = kNone;
  for (std::size_t i = 0; i < body.facets.size(); ++i) {
    const double gap = body.facets[i].offset - body.facets[i].normal.dot(side.point_L());
    if (!(gap < least)) continue;
    least = gap;
    nearest = static_cast<std::int32_t>(i);
  }
  if (nearest == kNone) return;
  side.place_on_facet(facet_under(body, nearest, side.point_L()), side.point_L());
}

// The upper bound holds only if its points lie on the bodies. A point that the iteration has left
// outside its facet's polygon goes to the nearest side of the polygon.
void keep_on_body(ActiveFeature& side) noexcept {
  if (side.feature() == FeatureKind::kInside) leave_inside(side);
  if (side.feature() != FeatureKind::kFacet) return;
  const Facet& facet = side.facet();
  const std::int32_t crossed = crossed_limit(side.body(), facet, side.point_L());
  if (crossed == kNone) return;
  const std::int32_t index = side.index();
  side.place_on_edge(side.body().facet_edges[facet.first_side + crossed].edge, side.point_L());
  side.place(FeatureKind::kFacet, index, side.point_L());
}

}  // namespace

Dqp3Outcome dqp3(ActiveFeature& a, ActiveFeature& b, double contact) noexcept {
  assert(!(contact < 0.0));
  const Dqp3Outcome outcome = iterate(a, b, contact);
  assert(outcome.end != Dqp3End::kCertified || outcome.separating_direction.norm() > 0.0);
  keep_on_body(a);
  keep_on_body(b);
  return outcome;
}

}  // namespace clearance
