// Stages 4 and 5 of a tick: which pairs are evaluated, and with how much of the budget? (§4.6)
//
// Every bound is true before and after; the schedule decides only how tight it is. Published pairs
// are evaluated in every tick, as long as the budget covers them and everything that competes with
// them. Of the others the culling says which are active, and among those:
//  1. the minimum: in order of carried lower bound, until none left can beat the smallest upper
//     bound; the horizon below which pairs are active follows that (MinimumSearch);
//  2. bins by the number of ticks until contact, or a zone's threshold, can be reached: the first
//     bins every tick, nearest first (UrgencyBins);
//  3. what the sweep needs for pairs that are outside their zones, but may have been inside since
//     the last tick, is kept from all that follows;
//  4. published pairs, if the budget covers them after all;
//  5. round-robin, a share of all pairs, culled or not, and published pairs that the budget does
//     not cover at once (RoundRobin). What that takes is kept from 1 to 4;
//  6. pairs that a tighter bound may cull are re-evaluated.
// Order and outcome depend on the inputs only: no clock, no addresses, no number of workers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/refresh_share.hpp"
#include "monitor/broad_phase/culling.hpp"
#include "monitor/pairs/published_pairs.hpp"
#include "monitor/schedule/minimum_search.hpp"
#include "monitor/schedule/round_robin.hpp"
#include "monitor/schedule/urgency_bins.hpp"
#include "monitor/swept/zone_crossings.hpp"

namespace clearance {

// What stage 4 decides before anything is evaluated.
struct Schedule {
  bool published_at_once = false;  // all that are known, first of all: the budget covers them and
                                   // whatever is urgent
  std::uint32_t kept = 0;          // queries kept for the round-robin refresh
};

class Scheduler {
 public:
  // `pool` and `levels` must outlive it.
  Scheduler(const Scene& scene, const RefreshShare& share, const std::vector<PosedPart>& parts,
            const PairTable& table, const ZoneLevels& levels, WorkerPool& pool);

  // Pairs that the broad phase is not told of: evaluated, or looked at, in every tick.
  [[nodiscard]] std::span<const std::uint32_t> left_out() const noexcept;

  // Stage 4, after the culling.
  [[nodiscard]] Schedule schedule(const Culling& culling, const Evaluation& evaluation) noexcept;

  // Stage 5. Leaves budget for the zone crossings that it finds.
  void evaluate(const Schedule& schedule, const Zones& zones, Culling& culling,
                ZoneCrossings& crossings, Evaluation& evaluation) noexcept;

  // The smallest upper bound of any pair that the last search for the minimum saw, m.
  [[nodiscard]] double minimum_upper() const noexcept { return minimum_.smallest_upper(); }
  // The tick in which a pair was last refreshed: evaluated, or proved far by the models of its
  // objects; 0: never.
  [[nodiscard]] std::uint64_t refreshed_cycle(std::uint32_t pair, const Culling& culling,
                                              const PairTable& table) const noexcept;
  // The same of the stalest pair that is known; the cycle itself: none is stale. Exact, but while
  // pairs are met for the first time or come back into sight: then none is older.
  [[nodiscard]] std::uint64_t oldest_refresh(const Schedule& schedule, const Culling& culling,
                                             const Evaluation& evaluation) const noexcept;

 private:
  void look_at_published(const Schedule& schedule, const Evaluator& evaluator) noexcept;
  void re_evaluate_active(const Evaluator& evaluator) noexcept;

  PublishedPairs published_;
  MinimumSearch minimum_;
  UrgencyBins urgency_;
  RoundRobin round_robin_;
  WorkerPool& pool_;
  std::vector<std::uint32_t> re_evaluated_;
};

}  // namespace clearance
