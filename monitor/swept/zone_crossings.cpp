#include "monitor/swept/zone_crossings.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/motion/directed_rounding.hpp"
#include "monitor/pairs/pair_bounds.hpp"

namespace clearance {
namespace {

// At the rows that the objects' travel leaves open; no more of them once one was nearer.
SweptBounds look_closer(std::uint32_t pair, double level, double travel,
                        Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  if (table.entries[pair].carried_cycle != evaluation.cycle) {
    travel = rounded_up(travel + travelled_since(pair, evaluation.objects, table));
  }
  SweptBounds all{.lower = kInfinity};
  for (std::uint32_t row = table.entries[pair].first_row; row < table.entries[pair].end_row;
       ++row) {
    SweptBounds bounds{.lower = rounded_down(table.lower[row] - travel)};
    const bool matters = bounds.lower < level && !(all.upper < level);
    if (matters && evaluation.queries_left >= SweptSearch::kLeastQueries) {
      const SweptBounds found = SweptSearch(row, evaluation).decide(level, evaluation);
      bounds.lower = std::max(bounds.lower, found.lower);
      bounds.upper = found.upper;
    }
    all.lower = std::min(all.lower, bounds.lower);
    all.upper = std::min(all.upper, bounds.upper);
  }
  return all;
}

}  // namespace

SweptBounds passage_of(std::uint32_t pair, double level, Evaluation& evaluation) noexcept {
  const TrackedObject& a = evaluation.objects[evaluation.table.entries[pair].object_a];
  const TrackedObject& b = evaluation.objects[evaluation.table.entries[pair].object_b];
  if (a.began || b.began || a.leapt || b.leapt) return {};
  const double unseen = rounded_up(a.unseen_since + b.unseen_since);
  const SweptBounds found =
      look_closer(pair, rounded_up(level + unseen), rounded_up(a.travel + b.travel), evaluation);
  return {rounded_down(found.lower - unseen), rounded_up(found.upper + unseen)};
}

void ZoneCrossings::look_at(std::uint32_t pair, const Zones& zones,
                            Evaluation& evaluation) noexcept {
  if (decided_.size() == decided_.capacity()) return;
  const PairTable& table = evaluation.table;
  const PairEntry& entry = table.entries[pair];
  const std::vector<TrackedObject>& objects = evaluation.objects;
  const TrackedObject& a = objects[entry.object_a];
  const TrackedObject& b = objects[entry.object_b];
  if (a.travel + b.travel == 0.0 || a.began || b.began || a.leapt || b.leapt) return;

  const double unseen_now = rounded_up(a.may_have_moved + b.may_have_moved);
  const double unseen = rounded_up(a.unseen_since + b.unseen_since);
  const double now = rounded_down(entry.least_lower - unseen_now);
  if (!(zones.undecided(pair, now, -kInfinity) > -kInfinity)) return;
  const double known = lower_since_last_tick(pair, entry.least_lower, objects, evaluation.cycle,
                                             table, Since::kByRelative);
  SweptBounds bounds{.lower = rounded_down(known - unseen)};
  double level = zones.undecided(pair, now, bounds.lower);
  if (!(level > -kInfinity)) return;
  while (level > -kInfinity && evaluation.queries_left >= SweptSearch::kLeastQueries) {
    const SweptBounds found = passage_of(pair, level, evaluation);
    bounds.lower = std::max(bounds.lower, found.lower);
    bounds.upper = std::min(bounds.upper, found.upper);
    level = zones.undecided(pair, std::nextafter(level, -kInfinity), bounds.lower);
  }
  decided_.push_back({pair, bounds});
}

void ZoneCrossings::finish() noexcept { std::ranges::sort(decided_, {}, &Decided::pair); }

SweptBounds ZoneCrossings::of(std::uint32_t pair) const noexcept {
  const auto found = std::ranges::lower_bound(decided_, pair, {}, &Decided::pair);
  return found == decided_.end() || found->pair != pair ? SweptBounds{} : found->bounds;
}

}  // namespace clearance
