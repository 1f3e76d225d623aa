// Which pairs are evaluated this tick? (§4.6)
//
// Every bound is true before and after; triage decides only how tight it is. Pairs whose figures
// somebody asked for (the published ones) are evaluated in every tick, as long as the budget covers
// them and everything that competes with them. Of the others the broad phase says which are awake,
// and among those:
//  1. the minimum: in order of carried lower bound, until none left can beat the smallest upper
//     bound; the horizon below which pairs are awake follows that;
//  2. bins by the number of ticks until contact, or a zone's threshold, can be reached (urgency):
//     the first bins every tick, nearest first;
//  3. pairs that are outside their zones, but may have been inside since the last tick (passages);
//  4. published pairs, if the budget covers them after all;
//  5. a share of all pairs, asleep or not, the stalest first, so that each is refreshed in time: by
//     the balls around its objects where these prove it far, else by an evaluation; then published
//     pairs in turn, where the budget does not cover them. What that takes (RefreshBudget) is kept
//     back from 1 to 4;
//  6. pairs that a tighter bound may put to sleep.
// Order and outcome depend on the inputs only: no clock, no addresses, no number of workers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/refresh_share.hpp"
#include "monitor/broad_phase/broad_phase.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/pairs/hull_bound.hpp"
#include "monitor/pairs/known_pairs.hpp"
#include "monitor/pairs/published_pairs.hpp"
#include "monitor/pairs/worker_pool.hpp"
#include "monitor/schedule/refresh_budget.hpp"
#include "monitor/schedule/refresh_queue.hpp"
#include "monitor/schedule/urgency_bins.hpp"
#include "monitor/swept/zone_crossings.hpp"

namespace clearance {

class Scheduler {
 public:
  // `pool` must outlive the triage.
  Scheduler(const Scene& scene, const std::vector<PosedPart>& parts, const PairTable& table,
            WorkerPool& pool);

  // Carries what has to be carried and evaluates what is due; returns how many queries that took,
  // at most Scene::budget. `changed`: at least the objects that have moved, or of which something
  // else is known than in the last tick. `zones` have begun this tick.
  std::uint32_t evaluate_due(const std::vector<TrackedObject>& objects,
                             std::span<const std::uint32_t> changed,
                             const std::vector<PosedPart>& parts, std::uint64_t cycle,
                             const Zones& zones, PairTable& table) noexcept;

  // As of the last evaluate_due():
  // the pairs that were looked at, each once, and brought up to date. The others that are known are
  // each at least horizon() apart for the poses in use, and, for where late objects may be, farther
  // than their zones watch for; unless pending(), when pending_lower() is all that holds of some.
  // m.
  [[nodiscard]] std::span<const std::uint32_t> current() const noexcept { return current_; }
  [[nodiscard]] double horizon() const noexcept { return broad_phase_.horizon(); }
  [[nodiscard]] bool pending() const noexcept { return broad_phase_.pending(); }
  [[nodiscard]] double pending_lower() const noexcept { return broad_phase_.pending_lower(); }
  [[nodiscard]] const KnownPairs& counts() const noexcept { return counts_; }
  // what looking closer at the time since the last tick has told of a pair;
  [[nodiscard]] SweptBounds passage(std::uint32_t pair) const noexcept {
    return passages_.of(pair);
  }
  [[nodiscard]] bool any_passage() const noexcept { return passages_.any(); }
  // the tick in which a pair was last refreshed: evaluated, or proved far by the balls or the hulls
  // around its objects; 0: never;
  [[nodiscard]] std::uint64_t refreshed_cycle(std::uint32_t pair,
                                              const PairTable& table) const noexcept;
  // and the same of the stalest pair that is known; the cycle itself: none is stale. Exact, but
  // while pairs are met for the first time or come back into sight: then none is older.
  [[nodiscard]] std::uint64_t oldest_refresh() const noexcept { return oldest_refresh_; }

 private:
  void follow_minimum() noexcept;
  void find_horizon() noexcept;
  void begin(std::span<const std::uint32_t> changed, Evaluation& evaluation) noexcept;
  void look_at_asked(Evaluation& evaluation) noexcept;
  void look_at_awake(Evaluation& evaluation) noexcept;
  void settle_woken(Evaluation& evaluation) noexcept;
  void put_to_sleep(const Evaluation& evaluation) noexcept;
  void evaluate_minimum(Evaluation& evaluation) noexcept;
  void evaluate_closest(Evaluation& evaluation) noexcept;
  void evaluate_urgent(Evaluation& evaluation) noexcept;
  void decide_passages(const Zones& zones, Evaluation& evaluation) noexcept;
  void evaluate_first(const Zones& zones, Evaluation& evaluation) noexcept;
  void evaluate_asked(Evaluation& evaluation) noexcept;
  void evaluate_in_turn(Evaluation& evaluation) noexcept;
  void refresh_stalest(Evaluation& evaluation) noexcept;
  void set_aside(std::uint32_t pair, const Evaluation& evaluation) noexcept;
  template <class Enough>
  [[nodiscard]] bool by_models(std::uint32_t pair, std::uint32_t spared, Evaluation& evaluation,
                               const Enough& enough) noexcept;
  [[nodiscard]] bool refresh(std::uint32_t pair, Evaluation& evaluation) noexcept;
  void evaluate_restless(Evaluation& evaluation) noexcept;
  void evaluate_stalest(std::span<std::uint32_t> pairs, Evaluation& evaluation) noexcept;
  void evaluate_these(std::span<const std::uint32_t> pairs, Evaluation& evaluation) noexcept;
  void note_evaluated(std::uint32_t pair, const Evaluation& evaluation) noexcept;
  void look_at(std::uint32_t pair, Evaluation& evaluation) noexcept;
  void list(std::uint32_t pair) noexcept;
  void find_oldest(const Evaluation& evaluation) noexcept;
  [[nodiscard]] bool has_room(const PairTable& table) const noexcept;

  const std::uint32_t budget_;
  const RefreshShare share_;
  RefreshBudget asked_pace_, others_pace_;
  const std::uint32_t per_tick_;  // pairs to be refreshed a tick
  PublishedPairs asked_;
  bool asked_done_ = false;     // those that are known were all evaluated
  std::size_t next_asked_ = 0;  // whose turn it is
  KnownPairs counts_;
  UrgencyBins urgency_;
  BroadPhase broad_phase_;
  HullBound hulls_;
  RefreshQueue queue_;  // of the pairs that the broad phase is told of
  ZoneCrossings passages_;
  std::size_t passages_decided_ = 0;  // of current_
  WorkerPool& pool_;
  double smallest_upper_ = kInfinity;  // of the pairs looked at, but for those in turn, m
  std::uint64_t oldest_refresh_ = 0;
  std::vector<std::uint8_t> is_current_;  // by pair: is in current_
  // Pairs, each list with room for all that it can ever hold.
  std::vector<std::uint32_t> awake_, current_, scratch_;
};

}  // namespace clearance
