// Which pairs are evaluated this tick? (§4.6)
//
// Every bound is true before and after; triage decides only how tight it is. When the budget covers
// every pair of the scene, all are evaluated. When it does not, the broad phase says which pairs
// are awake, and among those:
//  1. the minimum: in order of carried lower bound, until none left can beat the smallest upper
//     bound; the horizon below which pairs are awake follows that;
//  2. bins by the number of ticks until a pair's distance can fall below what somebody watches for
//     (a zone's threshold and both margins, at least contact), by stated and measured speeds: the
//     first bins every tick, nearest first. What a carried bound does not prove outside its zones
//     is in the first bin;
//  3. published pairs, all of them or in turn;
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
  // the pairs that were awake, of those that are known. The others that are known are each at least
  // horizon() apart for the poses in use, and, for where late objects may be, farther than their
  // zones watch for; unless pending(), when pending_lower() is all that holds of some. m.
  [[nodiscard]] std::span<const std::uint32_t> awake() const noexcept { return known_; }
  [[nodiscard]] double horizon() const noexcept { return broad_phase_.horizon(); }
  [[nodiscard]] bool pending() const noexcept { return broad_phase_.pending(); }
  [[nodiscard]] double pending_lower() const noexcept { return broad_phase_.pending_lower(); }
  [[nodiscard]] const PairCounts& counts() const noexcept { return counts_; }
  // those with ObjectPair::publish;
  [[nodiscard]] std::span<const std::uint32_t> published() const noexcept { return published_; }
  // pairs that were evaluated;
  [[nodiscard]] std::span<const std::uint32_t> evaluated() const noexcept { return evaluated_; }
  // and no known pair's last evaluation is older than this tick; 0: some never was.
  [[nodiscard]] std::uint64_t oldest_evaluation() const noexcept { return round_.oldest_turn(); }

 private:
  // Bin b < kUrgentBins: fewer than 2^b ticks. At 1 kHz the last of them ends 8 ms ahead.
  static constexpr std::size_t kUrgentBins = 4;
  static constexpr double kUrgentTicks = 8.0;

  void follow_minimum() noexcept;
  void find_horizon() noexcept;
  void settle_woken(const std::vector<ObjectState>& objects, Evaluation& evaluation) noexcept;
  void list_known(const std::vector<ObjectState>& objects, const PairTable& table) noexcept;
  void put_to_sleep(const std::vector<ObjectState>& objects, const PairTable& table) noexcept;
  void evaluate_minimum(const std::vector<ObjectState>& objects, Evaluation& evaluation) noexcept;
  void evaluate_closest(Evaluation& evaluation) noexcept;
  void evaluate_urgent(const std::vector<ObjectState>& objects, Evaluation& evaluation) noexcept;
  void evaluate_published(const std::vector<ObjectState>& objects, Evaluation& evaluation) noexcept;
  void evaluate_in_turn(const std::vector<ObjectState>& objects, Evaluation& evaluation) noexcept;
  void evaluate_restless(Evaluation& evaluation) noexcept;
  void evaluate_stalest(std::span<std::uint32_t> pairs, Evaluation& evaluation) noexcept;
  void evaluate_once(std::uint32_t pair, Evaluation& evaluation) noexcept;
  [[nodiscard]] bool is_known(std::uint32_t pair, const std::vector<ObjectState>& objects,
                              const PairTable& table) const noexcept;
  [[nodiscard]] std::size_t bin_of(std::uint32_t pair, const std::vector<ObjectState>& objects,
                                   const PairTable& table) const noexcept;
  [[nodiscard]] double speed_of(std::uint32_t object, const ObjectState& state) const noexcept;

  const std::uint32_t budget_;
  const double period_s_;
  bool everything_;         // the budget covers all pairs: nothing ever sleeps
  std::uint32_t per_tick_;  // pairs to be refreshed a tick
  // By object.
  std::vector<double> reach_;         // no point of it is farther from its origin, m
  std::vector<double> stated_speed_;  // of any point of it, m/s; 0: fixed, or nobody said
  // By object pair.
  std::vector<double> watch_below_;       // m; never less than 0
  std::vector<std::uint32_t> published_;  // pairs
  std::size_t next_published_ = 0;        // whose turn it is
  PairCounts counts_;
  BroadPhase broad_phase_;
  RefreshRound round_;
  double smallest_upper_ = kInfinity;  // of the awake pairs this tick, m
  // Pairs, each list with room for all that it can ever hold.
  std::vector<std::uint32_t> awake_, known_, scratch_, evaluated_;
};

}  // namespace clearance
