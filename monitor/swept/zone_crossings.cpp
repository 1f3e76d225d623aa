#include "monitor/swept/zone_crossings.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/motion/directed_rounding.hpp"
#include "monitor/pairs/pair_bounds.hpp"

namespace clearance {
namespace {

// At the part pairs that the objects' displacement leaves open; no more of them once one was
// nearer.
SweptBounds look_closer(std::uint32_t pair, double level, double displacement,
                        Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  if (table.entries[pair].carried_cycle != evaluation.cycle) {
    displacement = rounded_up(displacement + displacement_since(pair, evaluation.objects, table));
  }
  SweptBounds all{.lower = kInfinity};
  for (std::uint32_t part_pair = table.entries[pair].first_part_pair;
       part_pair < table.entries[pair].end_part_pair; ++part_pair) {
    SweptBounds bounds{.lower = rounded_down(table.lower[part_pair] - displacement)};
    const bool matters = bounds.lower < level && !(all.upper < level);
    if (matters && evaluation.budget.left() >= SweptSearch::kLeastQueries) {
      const SweptBounds found = SweptSearch(part_pair, evaluation).decide(level, evaluation);
      bounds.lower = std::max(bounds.lower, found.lower);
      bounds.upper = found.upper;
    }
    all.lower = std::min(all.lower, bounds.lower);
    all.upper = std::min(all.upper, bounds.upper);
  }
  return all;
}

// It was known at the last tick, and is where it can have come since.
bool has_swept_motion(const TrackedObject& object) noexcept {
  return !object.first_seen && !object.discontinuous;
}

}  // namespace

SweptBounds swept_bounds_of(std::uint32_t pair, double level, Evaluation& evaluation) noexcept {
  const TrackedObject& a = evaluation.objects[evaluation.table.entries[pair].object_a];
  const TrackedObject& b = evaluation.objects[evaluation.table.entries[pair].object_b];
  if (!has_swept_motion(a) || !has_swept_motion(b)) return {};
  const double unseen = rounded_up(a.unseen_since + b.unseen_since);
  const SweptBounds found = look_closer(pair, rounded_up(level + unseen),
                                        rounded_up(a.displacement + b.displacement), evaluation);
  return {rounded_down(found.lower - unseen), rounded_up(found.upper + unseen)};
}

void ZoneCrossings::find(std::span<const std::uint32_t> seen, const Zones& zones,
                         const Evaluation& evaluation) noexcept {
  for (; looked_at_ < seen.size(); ++looked_at_) {
    const std::uint32_t pair = seen[looked_at_];
    if (!is_far(pair, levels_.largest_threshold(pair), evaluation))
      look_at(pair, zones, evaluation);
  }
}

void ZoneCrossings::look_at(std::uint32_t pair, const Zones& zones,
                            const Evaluation& evaluation) noexcept {
  if (crossings_.size() == crossings_.capacity()) return;
  const PairTable& table = evaluation.table;
  const PairEntry& entry = table.entries[pair];
  const std::vector<TrackedObject>& objects = evaluation.objects;
  const TrackedObject& a = objects[entry.object_a];
  const TrackedObject& b = objects[entry.object_b];
  if (a.displacement + b.displacement == 0.0 || !has_swept_motion(a) || !has_swept_motion(b))
    return;

  const double unseen_now = rounded_up(a.may_have_moved + b.may_have_moved);
  const double unseen = rounded_up(a.unseen_since + b.unseen_since);
  const double now = rounded_down(entry.least_lower - unseen_now);
  if (!(zones.undecided(pair, now, -kInfinity) > -kInfinity)) return;
  const double known = lower_since_last_tick(pair, entry.least_lower, objects, evaluation.cycle,
                                             table, SweptPrecision::kByRelativeDisplacement);
  const double swept_lower = rounded_down(known - unseen);
  if (!(zones.undecided(pair, now, swept_lower) > -kInfinity)) return;
  crossings_.push_back({pair, now, {.lower = swept_lower}});
}

void ZoneCrossings::sweep(std::span<const std::uint32_t> seen, const Zones& zones,
                          Evaluation& evaluation) noexcept {
  find(seen, zones, evaluation);
  for (Crossing& crossing : crossings_) decide(zones, evaluation, crossing);
  std::ranges::sort(crossings_, {}, &Crossing::pair);
}

// Level by level, from the farthest zone threshold down.
void ZoneCrossings::decide(const Zones& zones, Evaluation& evaluation,
                           Crossing& crossing) noexcept {
  SweptBounds& bounds = crossing.bounds;
  double level = zones.undecided(crossing.pair, crossing.now, bounds.lower);
  while (level > -kInfinity && evaluation.budget.left() >= SweptSearch::kLeastQueries) {
    const SweptBounds found = swept_bounds_of(crossing.pair, level, evaluation);
    bounds.lower = std::max(bounds.lower, found.lower);
    bounds.upper = std::min(bounds.upper, found.upper);
    level = zones.undecided(crossing.pair, std::nextafter(level, -kInfinity), bounds.lower);
  }
}

SweptBounds ZoneCrossings::of(std::uint32_t pair) const noexcept {
  const auto found = std::ranges::lower_bound(crossings_, pair, {}, &Crossing::pair);
  return found == crossings_.end() || found->pair != pair ? SweptBounds{} : found->bounds;
}

}  // namespace clearance
