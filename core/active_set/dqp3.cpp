#include "core/active_set/dqp3.hpp"

#include "core/active_set/alpha_step_length.hpp"
#include "core/active_set/delta_step.hpp"
#include "core/active_set/lambda_multipliers.hpp"
#include "core/active_set/separating_direction.hpp"
#include "core/numerics/error_constants.hpp"

namespace clearance {
namespace {

// Far above the longest walk of the corpus.
constexpr std::uint16_t kIterations = 1000;

// Steps that bring no gain in doubles and yet are steps in exact arithmetic: along edges shorter
// than the rounding of their ends, as where four planes all but meet. More of them mean that
// rounding goes in circles.
constexpr int kStepsWithoutGain = 12;

// One step of both points towards `to`. Each goes as far as its own facets allow (§3.4.1); where
// that would take them apart, both go the same fraction of the way, which cannot. True if nothing
// blocked.
bool step(ActiveFeature& a, ActiveFeature& b, const Delta& to) noexcept {
  const Vec3 move_a = to.a - a.common(), move_b = to.b - b.common();
  Alpha alpha_a = alpha(a, move_a), alpha_b = alpha(b, move_b);
  const bool free = alpha_a.blocking == kNone && alpha_b.blocking == kNone;
  if (!free) {
    const Vec3 between = b.common() - a.common();
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

// Follows an edge or a facet, or leaves for the inside, from where x is.
void release(ActiveFeature& side, const Lambda& l) noexcept {
  side.place(l.to, l.index, side.own());
}

// On the far side of a body, where facets are parallel to within rounding, no edge and no facet
// leads closer, and yet its inside does: a body's farthest points along the direction are those
// that it does not. The inside itself may be that thin (of the body's size), and beyond that
// rounding decides.
constexpr double kThin = 0x1p-44;

bool leave_for_inside(ActiveFeature& side, const Vec3& direction_in_common) noexcept {
  if (side.feature() == FeatureKind::kInside) return false;
  const ConvexBody& body = side.body();
  const Vec3 direction = side.direction_to_own(direction_in_common);
  const double thin = kThin * direction.norm();
  const bool closer = (body.interior - side.own()).dot(direction) > thin * body.bounding_radius ||
                      body.recession_cone.inwards.dot(direction) > thin;
  if (closer) side.place_inside(side.own());
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
  while (outcome.iterations < kIterations) {
    ++outcome.iterations;
    if (!step(a, b, delta(a, b))) continue;
    const SeparatingDirection found = separating_direction(a, b);
    const Vec3& direction = found.vector;
    outcome.separating_direction = direction;
    const double distance2 = (b.common() - a.common()).squaredNorm();
    if (distance2 <= contact * contact) return ended(Dqp3End::kContact);
    if (distance2 < closest2) {
      closest2 = distance2;
    } else if (++without_gain > kStepsWithoutGain) {
      return ended(Dqp3End::kStalled);
    }
    const Lambda of_a = lambda(a, direction), of_b = lambda(b, -direction);
    const double best = std::max(of_a.derivative, of_b.derivative);
    // Zero to rounding: degenerate, and neither sign of it is certified.
    if (best * best < kDerivativeError * kDerivativeError * distance2) {
      if (leave_for_inside(a, direction) || leave_for_inside(b, -direction)) continue;
      return ended(Dqp3End::kOptimal);
    }
    if (best < 0.0) return ended(found.exact ? Dqp3End::kCertified : Dqp3End::kOptimal);
    // Of the two bodies the one whose release brings them closer faster.
    if (of_a.derivative >= of_b.derivative) {
      release(a, of_a);
    } else {
      release(b, of_b);
    }
  }
  return outcome;
}

// Between a point inside and the planes of facets that meet at a sharp edge or corner there may be
// no more than rounding, and the point past the edge by much more: of the body's reach and of how
// far out the point is.
constexpr double kInsideBeyondRounding = 16 * kUlp;

// From the inside, unless there beyond rounding, to the facet that is nearest.
void leave_inside(ActiveFeature& side) noexcept {
  const ConvexBody& body = side.body();
  double least = kInsideBeyondRounding * (body.bounding_radius + side.own().norm());
  std::int32_t nearest = kNone;
  for (std::size_t i = 0; i < body.facets.size(); ++i) {
    const double gap = body.facets[i].offset - body.facets[i].normal.dot(side.own());
    if (!(gap < least)) continue;
    least = gap;
    nearest = static_cast<std::int32_t>(i);
  }
  if (nearest == kNone) return;
  side.place_on_facet(facet_under(body, nearest, side.own()), side.own());
}

// An upper bound is worth no more than that its points are on the bodies: one that the iteration
// has left outside its facet's polygon goes to the polygon's nearest side.
void keep_on_body(ActiveFeature& side) noexcept {
  if (side.feature() == FeatureKind::kInside) leave_inside(side);
  if (side.feature() != FeatureKind::kFacet) return;
  const Facet& facet = side.facet();
  const std::int32_t beyond = crossed_limit(side.body(), facet, side.own());
  if (beyond == kNone) return;
  const std::int32_t index = side.index();
  side.place_on_edge(side.body().facet_edges[facet.first_side + beyond].edge, side.own());
  side.place(FeatureKind::kFacet, index, side.own());
}

}  // namespace

Dqp3Outcome dqp3(ActiveFeature& a, ActiveFeature& b, double contact) noexcept {
  const Dqp3Outcome outcome = iterate(a, b, contact);
  keep_on_body(a);
  keep_on_body(b);
  return outcome;
}

}  // namespace clearance
