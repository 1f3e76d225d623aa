#include "monitor/schedule/zone_crossings.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/interface/invariant.hpp"
#include "monitor/pairs/carried_bounds.hpp"
#include "monitor/pairs/pair_bounds.hpp"
#include "monitor/schedule/swept_search.hpp"

namespace clearance {
namespace {

// Searches the part pairs that displacement alone leaves open, until one of them was nearer than
// `level`. `displacement`: of both objects since the last tick, m.
SweptBounds search_part_pairs(std::uint32_t pair, double level, double displacement,
                              const TickView& view, Budget& budget) noexcept {
  const PairTable& table = view.pairs;
  if (!is_carried(pair, view)) {
    displacement = rounded_up(displacement + displacement_since(pair, view));
  }
  SweptBounds all{.lower = kInfinity};
  for (std::uint32_t part_pair = table.first_part_pair(pair); part_pair < table.end_part_pair(pair);
       ++part_pair) {
    SweptBounds bounds{.lower = rounded_down(table.lower[part_pair] - displacement)};
    const bool matters = bounds.lower < level && !(all.upper < level);
    if (matters && budget.left() >= SweptSearch::kLeastQueries) {
      const SweptBounds found = SweptSearch(part_pair, view).decide(level, budget);
      bounds.lower = std::max(bounds.lower, found.lower);
      bounds.upper = found.upper;
    }
    all.lower = std::min(all.lower, bounds.lower);
    all.upper = std::min(all.upper, bounds.upper);
  }
  return all;
}

// Returns true when the object was known at the last tick and has made no discontinuity since.
bool has_swept_motion(const TrackedObject& object) noexcept {
  return !object.newly_known && !object.discontinuous;
}

// Returns true when displacement alone proves that the pair was outside its zones since the last
// tick. Most pairs are decided here.
inline bool stayed_outside(std::uint32_t pair, double threshold, const TickView& view) noexcept {
  if (threshold == -kInfinity) return true;  // the pair has no zone
  const PairEntry& entry = view.pairs.entries[pair];
  const TrackedObject& a = view.objects[entry.object_a];
  const TrackedObject& b = view.objects[entry.object_b];
  const double displaced = 2.0 * (a.displacement + b.displacement) + (a.unobserved + b.unobserved);
  return rounded_down(entry.least_lower - rounded_up(displaced)) >= threshold;
}

}  // namespace

SweptBounds swept_bounds_of(std::uint32_t pair, double level, const TickView& view,
                            Budget& budget) noexcept {
  const TrackedObject& a = view.objects[view.pairs.entries[pair].object_a];
  const TrackedObject& b = view.objects[view.pairs.entries[pair].object_b];
  if (!has_swept_motion(a) || !has_swept_motion(b)) return {};
  const double unobserved = rounded_up(a.unobserved + b.unobserved);
  const SweptBounds found =
      search_part_pairs(pair, rounded_up(level + unobserved),
                        rounded_up(a.displacement + b.displacement), view, budget);
  return {rounded_down(found.lower - unobserved), rounded_up(found.upper + unobserved)};
}

void ZoneCrossings::find(std::span<const std::uint32_t> updated, const Zones& zones,
                         const TickView& view) noexcept {
  crossings_.clear();
  examined_ = 0;
  find_more(updated, zones, view);
}

void ZoneCrossings::find_more(std::span<const std::uint32_t> updated, const Zones& zones,
                              const TickView& view) noexcept {
  for (; examined_ < updated.size(); ++examined_) {
    const std::uint32_t pair = updated[examined_];
    if (!stayed_outside(pair, levels_.largest_threshold(pair), view)) examine(pair, zones, view);
  }
}

void ZoneCrossings::examine(std::uint32_t pair, const Zones& zones, const TickView& view) noexcept {
  if (crossings_.size() == crossings_.capacity()) return;
  const PairEntry& entry = view.pairs.entries[pair];
  const TrackedObject& a = view.objects[entry.object_a];
  const TrackedObject& b = view.objects[entry.object_b];
  if (a.displacement + b.displacement == 0.0 || !has_swept_motion(a) || !has_swept_motion(b))
    return;

  const double unobserved_now = rounded_up(a.may_have_moved + b.may_have_moved);
  const double unobserved = rounded_up(a.unobserved + b.unobserved);
  const double now = rounded_down(entry.least_lower - unobserved_now);
  if (!(zones.undecided(pair, now, -kInfinity) > -kInfinity)) return;
  const double known =
      lower_since_last_tick(pair, entry.least_lower, view, SweptPrecision::kByRelativeDisplacement);
  const double swept_lower = rounded_down(known - unobserved);
  if (!(zones.undecided(pair, now, swept_lower) > -kInfinity)) return;
  crossings_.push_back({pair, now, {.lower = swept_lower}});
}

std::uint32_t ZoneCrossings::queries() const noexcept {
  return static_cast<std::uint32_t>(crossings_.size()) * SweptSearch::kMostQueries;
}

void ZoneCrossings::sweep(std::span<const std::uint32_t> updated, const Zones& zones,
                          const TickView& view, Budget& budget) noexcept {
  find_more(updated, zones, view);
  for (Crossing& crossing : crossings_) {
    decide(zones, view, budget, crossing);
    CLEARANCE_INVARIANT(crossing.bounds.lower <= crossing.bounds.upper);
  }
  std::ranges::sort(crossings_, {}, &Crossing::pair);
}

// Level by level, from the largest zone threshold down.
void ZoneCrossings::decide(const Zones& zones, const TickView& view, Budget& budget,
                           Crossing& crossing) noexcept {
  SweptBounds& bounds = crossing.bounds;
  double level = zones.undecided(crossing.pair, crossing.now, bounds.lower);
  while (level > -kInfinity && budget.left() >= SweptSearch::kLeastQueries) {
    const SweptBounds found = swept_bounds_of(crossing.pair, level, view, budget);
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
