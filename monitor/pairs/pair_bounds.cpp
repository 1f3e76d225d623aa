#include "monitor/pairs/pair_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/closing_speed.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/relative_displacement.hpp"
#include "monitor/bodies/swept_bound.hpp"
#include "monitor/pairs/carried_bounds.hpp"

namespace clearance {
namespace {

// The relative motion of two objects takes 25 ns, so it is computed only where it may pay. This
// requires that their displacement is more than this share of their distance, ...
constexpr double kSmallDisplacement = 1.0 / 64.0;
// ... and that the directions of two evaluations leave more than this share of the displacement
// open.
constexpr double kSmallShare = 1.0 / 4096.0;

// The part pair with the smallest upper bound; evaluated ones come before all others.
std::uint32_t closest_part_pair(std::uint32_t pair, const PairTable& table) noexcept {
  std::uint32_t closest = table.first_part_pair(pair);
  const std::uint32_t end = table.end_part_pair(pair);
  for (std::uint32_t part_pair = closest + 1; part_pair < end; ++part_pair) {
    const bool evaluated = table.evaluations.cycle(part_pair) > 0;
    const bool closest_evaluated = table.evaluations.cycle(closest) > 0;
    if (evaluated != closest_evaluated ? evaluated
                                       : table.upper[part_pair] < table.upper[closest]) {
      closest = part_pair;
    }
  }
  return closest;
}

DistanceBounds bounds_as_carried(std::uint32_t pair, const PairTable& table) noexcept {
  return {table.entries[pair].least_lower, upper_of(pair, table)};
}

DistanceBounds pair_bounds_now(std::uint32_t pair, const TickView& view) noexcept {
  const double displacement = displacement_since(pair, view);
  DistanceBounds least{kInfinity, kInfinity};
  const std::uint32_t end = view.pairs.end_part_pair(pair);
  for (std::uint32_t part_pair = view.pairs.first_part_pair(pair); part_pair < end; ++part_pair) {
    const DistanceBounds now = bounds_now(part_pair, displacement, view);
    least.lower = std::min(least.lower, now.lower);
    least.upper = std::min(least.upper, now.upper);
  }
  return least;
}

// Returns the pair's status by this tick's evaluations. It is kCarried if a part pair that could be
// the closest was not evaluated in this tick.
PairStatus evaluated_status(std::uint32_t pair, std::uint32_t closest,
                            const TickView& view) noexcept {
  const PairTable& table = view.pairs;
  const std::uint64_t cycle = view.cycle;
  if (table.evaluations.cycle(closest) != cycle) return PairStatus::kCarried;
  PairStatus status = status_of(table.evaluations[closest].status);
  const std::uint32_t end = table.end_part_pair(pair);
  for (std::uint32_t part_pair = table.first_part_pair(pair); part_pair < end; ++part_pair) {
    if (part_pair == closest || table.lower[part_pair] >= table.upper[closest]) continue;
    if (table.evaluations.cycle(part_pair) != cycle) return PairStatus::kCarried;
    if (status_of(table.evaluations[part_pair].status) == PairStatus::kIterationLimit)
      status = PairStatus::kIterationLimit;
  }
  return status;
}

// A lower bound of the distance of two objects since the last tick, m. Both were known then and
// have made no discontinuity since. It uses the bounds `before` and `now`, and `along`, which the
// directions of two evaluations prove.
double lower_between_ticks(const TrackedObject& a, const TrackedObject& b, double before,
                           double now, double along, SweptPrecision precision) noexcept {
  const double displacement = rounded_up(a.displacement + b.displacement);
  if (displacement == 0.0) return now;
  const bool has_directions = along > -kInfinity;
  if (has_directions && along >= std::min(before, now) - kSmallShare * displacement)
    return std::min(now, along);
  const double lower = std::max(along, lower_by_ends(before, now, displacement));
  const bool matters =
      displacement > kSmallDisplacement * now && a.displacement > 0.0 && b.displacement > 0.0;
  if (precision == SweptPrecision::kByDisplacement || !matters) return std::min(now, lower);
  const double relative =
      std::min(displacement, relative_displacement(a.body_motion(), b.body_motion()));
  return std::min(now, std::max(lower, lower_by_ends(before, now, relative)));
}

double lower_by_evaluations(std::uint32_t pair, const TickView& view) noexcept {
  if (!is_evaluated(pair, view)) return -kInfinity;
  return view.pairs.evaluations[view.pairs.first_part_pair(pair)].lower_between;
}

// The result of bounds_of() for the usual pair, which was brought up to date in this tick, in a
// third of the time.
PairBounds bounds_of_one_part_pair(std::uint32_t pair, const TrackedObject& a,
                                   const TrackedObject& b, const TickView& view,
                                   SweptPrecision precision) noexcept {
  const PairTable& table = view.pairs;
  const PairEntry& entry = table.entries[pair];
  const std::uint32_t part_pair = table.first_part_pair(pair);
  const Evaluation& evaluation = table.evaluations[part_pair];
  const std::uint64_t evaluated = table.evaluations.cycle(part_pair);
  const double upper = table.upper[part_pair];
  const double between = is_evaluated(pair, view) ? evaluation.lower_between : -kInfinity;
  return {
      .status = evaluated == view.cycle ? status_of(evaluation.status) : PairStatus::kCarried,
      .lower = entry.least_lower,
      .upper = upper,
      .swept_lower =
          lower_between_ticks(a, b, entry.lower_before, entry.least_lower, between, precision),
      .swept_upper = upper,
      .part_pair = part_pair,
      .evaluated_cycle = evaluated,
  };
}

// Replaces bounds that hold for all postures within the stated errors by those along the directions
// of this tick's evaluations.
[[gnu::noinline]] void narrow(std::uint32_t pair, const TickView& view,
                              PairBounds& bounds) noexcept {
  const PairTable& table = view.pairs;
  const TrackedObject& a = view.objects[table.entries[pair].object_a];
  const TrackedObject& b = view.objects[table.entries[pair].object_b];
  const ErrorBounds& closest = table.errors[bounds.part_pair];
  if (!a.plain || !b.plain || !is_evaluated(pair, view)) return;
  const double lower_last_tick = table.entries[pair].lower_before;
  double lower = kInfinity, before = kInfinity, drift = 0.0;
  const std::uint32_t end = table.end_part_pair(pair);
  for (std::uint32_t part_pair = table.first_part_pair(pair); part_pair < end; ++part_pair) {
    const bool is_new = table.evaluations.cycle(part_pair) == view.cycle;
    const ErrorBounds& errors = table.errors[part_pair];
    lower = std::min(
        lower, is_new ? std::max(table.lower[part_pair], errors.lower) : table.lower[part_pair]);
    before =
        std::min(before, is_new ? std::max(lower_last_tick, errors.lower_before) : lower_last_tick);
    if (is_new) drift = std::max(drift, errors.drift);
  }
  if (table.evaluations.cycle(bounds.part_pair) == view.cycle) {
    const double upper = std::min(bounds.upper, closest.upper);
    bounds.upper = std::max(upper, lower);
    bounds.swept_upper = std::min(bounds.swept_upper, bounds.upper);
  }
  bounds.lower = std::max(bounds.lower, lower);
  // A direction that stays in the frame of a body turns in the world, and the errors along it
  // change.
  const double swept = lower_between_ticks(a, b, before, lower, lower_by_evaluations(pair, view),
                                           SweptPrecision::kByDisplacement);
  bounds.swept_lower = std::max(bounds.swept_lower, rounded_down(swept - drift));
  bounds.swept_lower = std::min(bounds.swept_lower, bounds.lower);
}

// By the direction of this tick's evaluation, if the bounds are by that.
double model_error(const PairBounds& bounds, const TrackedObject& a, const TrackedObject& b,
                   const TickView& view) noexcept {
  const ErrorBounds& errors = view.pairs.errors[bounds.part_pair];
  const bool is_new = is_evaluated(bounds.status);
  return is_new && a.plain && b.plain ? errors.loss : errors.between.largest;
}

// Widens the bounds by the unobserved motion of late objects.
void count_lateness_in(const TrackedObject& a, const TrackedObject& b,
                       PairBounds& bounds) noexcept {
  const double unobserved = a.unobserved + b.unobserved;
  if (unobserved > 0.0) {
    bounds.swept_lower = rounded_down(bounds.swept_lower - rounded_up(unobserved));
    bounds.swept_upper = rounded_up(bounds.swept_upper + rounded_up(unobserved));
  }
  const bool is_late = a.input.late || b.input.late;
  // The bodies that a sensor sees may have moved since its frame, although that is not late.
  if (!is_late && a.may_have_moved == 0.0 && b.may_have_moved == 0.0) return;
  const double may_have_moved = rounded_up(a.may_have_moved + b.may_have_moved);
  bounds.lower = rounded_down(bounds.lower - may_have_moved);
  bounds.upper = rounded_up(bounds.upper + may_have_moved);
  bounds.swept_lower = std::min(bounds.lower, bounds.swept_lower);
  if (is_late) bounds.status = PairStatus::kStale;
}

// The bounds in the table, brought together.
PairBounds bounds_by_table(std::uint32_t pair, const TickView& view,
                           SweptPrecision precision) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  const TrackedObject& a = view.objects[entry.object_a];
  const TrackedObject& b = view.objects[entry.object_b];
  const bool carried = is_carried(pair, view);
  if (a.plain && b.plain && carried && view.pairs.part_pairs_of(pair) == 1) {
    return bounds_of_one_part_pair(pair, a, b, view, precision);
  }
  PairBounds bounds;
  if (a.absent || b.absent) bounds.status = PairStatus::kAbsent;
  if (!a.known() || !b.known()) return bounds;
  const DistanceBounds now =
      carried ? bounds_as_carried(pair, view.pairs) : pair_bounds_now(pair, view);
  bounds.lower = now.lower;
  bounds.upper = bounds.swept_upper = now.upper;
  bounds.swept_lower = lower_since_last_tick(pair, now.lower, view, precision);
  bounds.part_pair = closest_part_pair(pair, view.pairs);
  bounds.evaluated_cycle = view.pairs.evaluations.cycle(bounds.part_pair);
  bounds.status = evaluated_status(pair, bounds.part_pair, view);
  if (!a.plain || !b.plain) count_lateness_in(a, b, bounds);
  return bounds;
}

}  // namespace

PairStatus status_of(DistanceStatus status) noexcept {
  switch (status) {
    case DistanceStatus::kConverged:
      return PairStatus::kConverged;
    case DistanceStatus::kTouching:
      return PairStatus::kTouching;
    case DistanceStatus::kOverlapping:
      return PairStatus::kOverlapping;
    case DistanceStatus::kIterationLimit:
    case DistanceStatus::kDepthNotAsked:
    case DistanceStatus::kBadPose:
      break;
  }
  return PairStatus::kIterationLimit;
}

PairReport unknown_report() noexcept {
  PairReport report;
  report.status = PairStatus::kUnknown;
  report.lower = report.swept_lower = -kInfinity;
  report.upper = kInfinity;
  report.distance = report.closing_speed = report.time_to_contact = report.model_error = kNan;
  report.stop_lower = kNan;
  report.witness_a = report.witness_b = report.normal = Vec3::Constant(kNan);
  return report;
}

double lower_since_last_tick(std::uint32_t pair, double lower, const TickView& view,
                             SweptPrecision precision) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  const TrackedObject& a = view.objects[entry.object_a];
  const TrackedObject& b = view.objects[entry.object_b];
  if (a.newly_known || b.newly_known) return lower;
  if (a.discontinuous || b.discontinuous) return -kInfinity;
  return lower_between_ticks(a, b, lower_last_tick(pair, view), lower,
                             lower_by_evaluations(pair, view), precision);
}

PairBounds bounds_of(std::uint32_t pair, const TickView& view, SweptPrecision precision) noexcept {
  if (view.errors == nullptr) [[likely]]
    return bounds_by_table(pair, view, precision);
  PairBounds bounds = bounds_by_table(pair, view, precision);
  narrow(pair, view, bounds);
  return bounds;
}

double stated_width(std::uint32_t pair, const PairBounds& bounds, const TickView& view) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  const double below =
      model_error(bounds, view.objects[entry.object_a], view.objects[entry.object_b], view);
  // The table's upper bound contains the largest error.
  const double above = view.pairs.largest_error(bounds.part_pair);
  return below + above - std::max(0.0, upper_of(pair, view.pairs) - bounds.upper);
}

void write_pair(std::uint32_t pair, const PairBounds& bounds, const TickView& view,
                PairReport& report) noexcept {
  const PairTable& table = view.pairs;
  const TrackedObject& a = view.objects[table.entries[pair].object_a];
  const TrackedObject& b = view.objects[table.entries[pair].object_b];
  if (!is_known(bounds.status)) report = unknown_report();
  report.pair = pair;
  report.age_a_ns = a.input.age_ns(view.now_ns);
  report.age_b_ns = b.input.age_ns(view.now_ns);
  report.refresh_age_cycles = view.cycle - table.entries[pair].refreshed_cycle;
  report.status = bounds.status;
  if (!is_known(bounds.status)) return;

  report.lower = bounds.lower;
  report.swept_lower = bounds.swept_lower;
  report.upper = bounds.upper;
  report.model_error = view.errors == nullptr ? 0.0 : model_error(bounds, a, b, view);
  const ClosestPoints& closest = table.evaluations[bounds.part_pair].closest;
  report.part_a = view.parts[table.part_a(bounds.part_pair)].index_in_object;
  report.part_b = view.parts[table.part_b(bounds.part_pair)].index_in_object;
  report.distance = closest.distance;
  report.witness_a = closest.witness_a;
  report.witness_b = closest.witness_b;
  const bool has_normal = !closest.normal.isZero(0.0);
  report.normal = has_normal ? closest.normal : Vec3::Constant(kNan);
  const bool has_speed = a.velocity_known() && b.velocity_known() && has_normal;
  report.closing_speed =
      has_speed ? closing_speed(velocity_at(closest.witness_a, a.pose, a.twist),
                                velocity_at(closest.witness_b, b.pose, b.twist), closest.normal)
                : kNan;
  report.time_to_contact = time_to_contact(report.distance, report.closing_speed);
  report.evaluated_cycle = bounds.evaluated_cycle;
}

}  // namespace clearance
