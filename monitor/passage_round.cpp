#include "monitor/passage_round.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/pair_summary.hpp"
#include "monitor/rounding.hpp"

namespace clearance {
namespace {

// At the rows that the objects' travel leaves open; no more of them once one was nearer.
PassageBounds look_closer(std::uint32_t pair, double level, double travel,
                          Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  if (table.carried_cycle[pair] != evaluation.cycle) {
    travel = rounded_up(travel + travelled_since(pair, evaluation.objects, table));
  }
  PassageBounds all{.lower = kInfinity};
  for (std::uint32_t row = table.first_row[pair]; row < table.first_row[pair + 1]; ++row) {
    PassageBounds bounds{.lower = rounded_down(table.lower[row] - travel)};
    const bool matters = bounds.lower < level && !(all.upper < level);
    if (matters && evaluation.queries_left >= Passage::kLeastQueries) {
      const PassageBounds found = Passage(row, evaluation).decide(level, evaluation);
      bounds.lower = std::max(bounds.lower, found.lower);
      bounds.upper = found.upper;
    }
    all.lower = std::min(all.lower, bounds.lower);
    all.upper = std::min(all.upper, bounds.upper);
  }
  return all;
}

}  // namespace

PassageBounds passage_of(std::uint32_t pair, double level, Evaluation& evaluation) noexcept {
  const ObjectState& a = evaluation.objects[evaluation.table.object_a[pair]];
  const ObjectState& b = evaluation.objects[evaluation.table.object_b[pair]];
  if (a.began || b.began || a.leapt || b.leapt) return {};
  const double unseen = rounded_up(a.unseen_since + b.unseen_since);
  const PassageBounds found =
      look_closer(pair, rounded_up(level + unseen), rounded_up(a.travel + b.travel), evaluation);
  return {rounded_down(found.lower - unseen), rounded_up(found.upper + unseen)};
}

void PassageRound::decide(std::uint32_t pair, const ZoneRound& zones,
                          Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  const std::vector<ObjectState>& objects = evaluation.objects;
  const ObjectState& a = objects[table.object_a[pair]];
  const ObjectState& b = objects[table.object_b[pair]];
  const double travel = rounded_up(a.travel + b.travel);
  if (travel == 0.0 || a.began || b.began || a.leapt || b.leapt) return;
  if (!zones.has(pair) || decided_.size() == decided_.capacity()) return;

  const double unseen_now = rounded_up(a.may_have_moved + b.may_have_moved);
  const double unseen = rounded_up(a.unseen_since + b.unseen_since);
  const double now = rounded_down(table.least_lower[pair] - unseen_now);
  // Most pairs are decided by less than what is known.
  const double at_least = table.least_lower[pair] - 2.0 * travel - unseen;
  if (!(zones.undecided(pair, now, at_least) > -kInfinity)) return;
  const double known = lower_since_last_tick(pair, table.least_lower[pair], objects,
                                             evaluation.cycle, table, Since::kByRelative);
  PassageBounds bounds{.lower = rounded_down(known - unseen)};
  double level = zones.undecided(pair, now, bounds.lower);
  if (!(level > -kInfinity)) return;
  while (level > -kInfinity && evaluation.queries_left >= Passage::kLeastQueries) {
    const PassageBounds found = passage_of(pair, level, evaluation);
    bounds.lower = std::max(bounds.lower, found.lower);
    bounds.upper = std::min(bounds.upper, found.upper);
    level = zones.undecided(pair, std::nextafter(level, -kInfinity), bounds.lower);
  }
  decided_.push_back({pair, bounds});
}

void PassageRound::finish() noexcept { std::ranges::sort(decided_, {}, &Decided::pair); }

PassageBounds PassageRound::find(std::uint32_t pair) const noexcept {
  const auto found = std::ranges::lower_bound(decided_, pair, {}, &Decided::pair);
  return found == decided_.end() || found->pair != pair ? PassageBounds{} : found->bounds;
}

}  // namespace clearance
