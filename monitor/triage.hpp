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
//  3. published pairs, where the budget did not cover all: in turn;
//  4. a share of all pairs in turn, asleep or not, so that each is refreshed in time;
//  5. pairs that a tighter bound may put to sleep.
// Order and outcome depend on the inputs only: no clock, no addresses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/broad_phase.hpp"
#include "monitor/evaluation.hpp"
#include "monitor/pair_counts.hpp"
#include "monitor/refresh_round.hpp"
#include "monitor/urgency.hpp"

namespace clearance {

class Triage {
 public:
  Triage(const Scene& scene, const std::vector<PlacedPart>& parts, const PairTable& table);

  // Carries what has to be carried and evaluates what is due; returns how many queries that took,
  // at most Scene::budget.
  std::uint32_t evaluate_due(const std::vector<ObjectState>& objects,
                             const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                             PairTable& table) noexcept;

  // As of the last evaluate_due():
  // the pairs that were looked at, each once, and brought up to date. The others that are known are
  // each at least horizon() apart for the poses in use, and, for where late objects may be, farther
  // than their zones watch for; unless pending(), when pending_lower() is all that holds of some.
  // m.
  [[nodiscard]] std::span<const std::uint32_t> current() const noexcept { return current_; }
  [[nodiscard]] double horizon() const noexcept { return broad_phase_.horizon(); }
  [[nodiscard]] bool pending() const noexcept { return broad_phase_.pending(); }
  [[nodiscard]] double pending_lower() const noexcept { return broad_phase_.pending_lower(); }
  [[nodiscard]] const PairCounts& counts() const noexcept { return counts_; }
  // how many pairs were evaluated;
  [[nodiscard]] std::uint64_t evaluated() const noexcept { return evaluated_; }
  // and no known pair's last evaluation is older than this tick; 0: some never was.
  [[nodiscard]] std::uint64_t oldest_evaluation() const noexcept { return round_.oldest_turn(); }

 private:
  void follow_minimum() noexcept;
  void find_horizon() noexcept;
  void look_at_asked(bool roomy, Evaluation& evaluation) noexcept;
  void look_at_awake(Evaluation& evaluation) noexcept;
  void settle_woken(Evaluation& evaluation) noexcept;
  void put_to_sleep(const Evaluation& evaluation) noexcept;
  void evaluate_minimum(Evaluation& evaluation) noexcept;
  void evaluate_closest(Evaluation& evaluation) noexcept;
  void evaluate_urgent(Evaluation& evaluation) noexcept;
  void evaluate_asked(Evaluation& evaluation) noexcept;
  void evaluate_in_turn(Evaluation& evaluation) noexcept;
  void evaluate_restless(Evaluation& evaluation) noexcept;
  void evaluate_stalest(std::span<std::uint32_t> pairs, Evaluation& evaluation) noexcept;
  void evaluate_once(std::uint32_t pair, Evaluation& evaluation) noexcept;
  void look_at(std::uint32_t pair, Evaluation& evaluation) noexcept;
  [[nodiscard]] bool has_room(const PairTable& table) const noexcept;

  const std::uint32_t budget_;
  const std::uint32_t per_tick_;      // pairs to be refreshed a tick
  std::vector<std::uint32_t> asked_;  // pairs whose figures somebody asked for
  std::uint32_t asked_rows_ = 0;
  // The budget covers those: they never sleep. Otherwise they do, and have their turns.
  const bool asked_every_tick_;
  std::size_t next_asked_ = 0;  // whose turn it is
  PairCounts counts_;
  Urgency urgency_;
  BroadPhase broad_phase_;
  RefreshRound round_;
  double smallest_upper_ = kInfinity;  // of the pairs looked at, but for those in turn, m
  std::uint64_t evaluated_ = 0;
  // Pairs, each list with room for all that it can ever hold.
  std::vector<std::uint32_t> awake_, current_, scratch_;
};

}  // namespace clearance
