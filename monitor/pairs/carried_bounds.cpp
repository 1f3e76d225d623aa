#include "monitor/pairs/carried_bounds.hpp"

#include <algorithm>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/pairs/carried_gap.hpp"

namespace clearance {
namespace {

// The displacement of an object between two readings. Equal readings mean that it has not moved.
double between(double before, double now) noexcept {
  return now == before ? 0.0 : rounded_up(now - before);
}

AccumulatedDisplacement accumulated(const PairEntry& entry, const TickView& view) noexcept {
  return {view.objects[entry.object_a].accumulated, view.objects[entry.object_b].accumulated};
}

}  // namespace

double displacement_since(std::uint32_t pair, const TickView& view) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  const double sum = between(entry.carried_at.a, view.objects[entry.object_a].accumulated) +
                     between(entry.carried_at.b, view.objects[entry.object_b].accumulated);
  return rounded_up(sum);
}

bool raised_this_tick(std::uint32_t pair, const TickView& view) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  return entry.carried_at.a > view.objects[entry.object_a].accumulated_last_tick ||
         entry.carried_at.b > view.objects[entry.object_b].accumulated_last_tick;
}

double lower_last_tick(std::uint32_t pair, const TickView& view) noexcept {
  const PairEntry& entry = view.pairs.entries[pair];
  if (entry.carried_cycle == view.cycle) return entry.lower_before;
  const AccumulatedDisplacement& then = entry.carried_at;
  const double before_a = view.objects[entry.object_a].accumulated_last_tick;
  const double before_b = view.objects[entry.object_b].accumulated_last_tick;
  const double lower = entry.least_lower;
  if (then.a == before_a && then.b == before_b) return lower;
  if (raised_this_tick(pair, view)) return -kInfinity;
  const double displacement = between(then.a, before_a) + between(then.b, before_b);
  return rounded_down(lower - rounded_up(displacement));
}

DistanceBounds bounds_now(std::uint32_t part_pair, double displacement,
                          const TickView& view) noexcept {
  const PairTable& table = view.pairs;
  DistanceBounds bounds{table.lower[part_pair], table.upper[part_pair]};
  if (displacement > 0.0) {
    bounds.lower = rounded_down(bounds.lower - displacement);
    bounds.upper = rounded_up(bounds.upper + displacement);
  }
  const PosedPart& part_a = view.parts[table.part_a(part_pair)];
  const PosedPart& part_b = view.parts[table.part_b(part_pair)];
  const Evaluation& evaluation = table.evaluations[part_pair];
  if (displacement > 0.0 && evaluation.gap > -kInfinity) {
    bounds.lower = std::max(bounds.lower,
                            lower_along(evaluation.closest.normal, evaluation.gap, part_a, part_b));
  }
  const Sphere& a = part_a.sphere_in_world;
  const Sphere& b = part_b.sphere_in_world;
  const double centres = (a.centre - b.centre).norm();
  const double radii = rounded_up(a.radius + b.radius + table.largest_error(part_pair));
  bounds.lower = std::max(bounds.lower, rounded_down(rounded_down(centres) - radii));
  bounds.upper = std::min(bounds.upper, rounded_up(rounded_up(centres) + radii));
  return bounds;
}

void carry(std::uint32_t pair, const OpenTick& tick) noexcept {
  PairTable& table = tick.table;
  PairEntry& entry = table.entries[pair];
  if (entry.carried_cycle == tick.cycle) return;
  const double displacement = displacement_since(pair, tick);
  note_carried(pair, tick);
  double least = kInfinity;
  const std::uint32_t end = table.end_part_pair(pair);
  for (std::uint32_t part_pair = table.first_part_pair(pair); part_pair < end; ++part_pair) {
    const DistanceBounds now = bounds_now(part_pair, displacement, tick);
    table.lower[part_pair] = now.lower;
    table.upper[part_pair] = now.upper;
    least = std::min(least, now.lower);
  }
  entry.least_lower = least;
}

void note_carried(std::uint32_t pair, const OpenTick& tick) noexcept {
  PairEntry& entry = tick.table.entries[pair];
  entry.lower_before = lower_last_tick(pair, tick);
  entry.carried_at = accumulated(entry, tick);
  entry.carried_cycle = tick.cycle;
}

void raise(std::uint32_t pair, double to, const OpenTick& tick) noexcept {
  PairTable& table = tick.table;
  PairEntry& entry = table.entries[pair];
  const double displacement = displacement_since(pair, tick);
  double least = kInfinity;
  const std::uint32_t end = table.end_part_pair(pair);
  for (std::uint32_t part_pair = table.first_part_pair(pair); part_pair < end; ++part_pair) {
    if (displacement > 0.0) {
      table.lower[part_pair] = rounded_down(table.lower[part_pair] - displacement);
      table.upper[part_pair] = rounded_up(table.upper[part_pair] + displacement);
    }
    table.lower[part_pair] = std::max(table.lower[part_pair], to);
    least = std::min(least, table.lower[part_pair]);
  }
  entry.least_lower = least;
  entry.carried_at = accumulated(entry, tick);
}

}  // namespace clearance
