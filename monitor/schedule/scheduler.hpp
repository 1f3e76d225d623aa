// Stages 'schedule', 'evaluate' and 'refresh' of a tick: they choose the pairs to evaluate and
// divide the budget (§4.6).
//
// Every bound is true before and after; the schedule decides only how tight it is. Published pairs
// are evaluated in every tick whose budget covers them and everything that competes with them.
// Among the others the culling says which are active, and these have their turns in this order:
//  1. evaluate: the minimum. Pairs are evaluated in the order of their carried lower bounds until
//     none left can beat the smallest upper bound. The horizon, below which pairs are active,
//     follows that (MinimumSearch);
//  2. evaluate: bins by the number of ticks until contact, or a zone's threshold, can be reached.
//     The first bins have their turn in every tick, the nearest first (UrgencyBins);
//  3. the tick keeps queries for the sweep, which later steps may not use. The sweep examines pairs
//     that are outside their zones but may have been inside since the last tick (ZoneCrossings);
//  4. refresh: published pairs, if the budget covers them after all;
//  5. refresh: a share of all pairs, culled or not, and of the published pairs that the budget does
//     not cover at once, round-robin (RoundRobin). The tick keeps their queries from 1 to 4;
//  6. refresh: pairs that a tighter bound may cull.
// Order and result depend on the inputs only: on no clock and no addresses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/refresh_share.hpp"
#include "monitor/pairs/published_pairs.hpp"
#include "monitor/schedule/culling.hpp"
#include "monitor/schedule/minimum_search.hpp"
#include "monitor/schedule/round_robin.hpp"
#include "monitor/schedule/urgency_bins.hpp"

namespace clearance {

// The decisions of stage 'schedule' about a tick.
struct Schedule {
  bool published_at_once = false;  // all published pairs are evaluated in one loop
  std::uint32_t kept = 0;          // queries that are kept for the refresh
};

// The results of a tick's evaluations for the next tick and for the report.
struct Evaluated {
  double smallest_upper = kInfinity;  // of any pair that the search for the minimum examined, m
  // The tick in which the stalest known pair was last refreshed. While pairs are met for the first
  // time, or come back, it may be too early, but no pair is older.
  std::uint64_t oldest_refresh = 0;
};

class Scheduler {
 public:
  // The scene and the levels must outlive it.
  Scheduler(const Scene& scene, const RefreshShare& share, const std::vector<PosedPart>& parts,
            const PairTable& table, const ZoneLevels& levels);

  // The pairs that are left out of the broad phase: every tick evaluates or updates them.
  [[nodiscard]] std::span<const std::uint32_t> left_out() const noexcept;

  // Stage 'schedule', after the culling.
  [[nodiscard]] Schedule schedule(const Culling& culling, const TickView& view,
                                  const Budget& budget) noexcept;

  // Stage 'evaluate'. False: the budget ran out.
  [[nodiscard]] bool evaluate_urgent(const Schedule& schedule, Culling& culling,
                                     const OpenTick& tick, Budget& budget) noexcept;

  // Stage 'refresh', with the queries that were kept for it. `urgent_done`: what the stage before
  // returned; if false, it is tried again with the queries that the refresh did not need.
  [[nodiscard]] Evaluated refresh(const Schedule& schedule, bool urgent_done, Culling& culling,
                                  const OpenTick& tick, Budget& budget) noexcept;

 private:
  void update_published(const Schedule& schedule, const Evaluator& evaluator) noexcept;
  void re_evaluate_active(const Evaluator& evaluator) noexcept;
  [[nodiscard]] std::uint64_t oldest_refresh(const Schedule& schedule, const Culling& culling,
                                             const TickView& view) const noexcept;

  PublishedPairs published_;
  std::vector<std::uint32_t> chosen_;  // scratch of the next two, with capacity for all pairs
  MinimumSearch minimum_;
  UrgencyBins urgency_;
  RoundRobin round_robin_;
  std::vector<std::uint32_t> re_evaluated_;
};

}  // namespace clearance
