// Which pairs are evaluated this tick? (§4.6)
//
// Every bound is true before and after; triage decides only how tight it is. When the budget covers
// all known pairs, all are evaluated. When it may not:
//  1. the minimum: in order of carried lower bound, until none left can beat the smallest upper
//     bound;
//  2. bins by the number of ticks until a pair's distance can fall below what somebody watches for
//     (a zone's threshold and both margins, at least contact), by stated and measured speeds: the
//     first bins every tick, nearest first. What a carried bound does not prove outside its zones
//     is in the first bin;
//  3. published pairs, if the budget covers them all;
//  4. the rest round-robin, stalest first.
// Order and outcome depend on the inputs only: no clock, no addresses.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/evaluation.hpp"

namespace clearance {

class Triage {
 public:
  Triage(const Scene& scene, const std::vector<PlacedPart>& parts, const PairTable& table);

  // Evaluates what is due; returns how many queries that took, at most Scene::budget.
  std::uint32_t evaluate_due(const std::vector<ObjectState>& objects,
                             const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                             PairTable& table) noexcept;

 private:
  // Bin b < kUrgentBins: fewer than 2^b ticks. At 1 kHz the last of them ends 8 ms ahead.
  static constexpr std::size_t kUrgentBins = 4;
  static constexpr std::size_t kPublishedBin = kUrgentBins;
  static constexpr std::size_t kBins = kUrgentBins + 2;

  // Lists them in known_ and returns how many rows they have.
  std::uint32_t find_known(const std::vector<ObjectState>& objects,
                           const PairTable& table) noexcept;
  void find_speeds(const std::vector<ObjectState>& objects) noexcept;
  void evaluate_closest(Evaluation& evaluation) noexcept;
  void evaluate_by_bins(const std::vector<ObjectState>& objects, Evaluation& evaluation) noexcept;
  void evaluate_stalest(std::span<std::uint32_t> pairs, Evaluation& evaluation) noexcept;
  [[nodiscard]] std::size_t bin_of(std::uint32_t pair, const std::vector<ObjectState>& objects,
                                   const PairTable& table) const noexcept;

  const std::uint32_t budget_;
  const double period_s_;
  // By object.
  std::vector<double> reach_;         // no point of it is farther from its origin, m
  std::vector<double> stated_speed_;  // of any point of it, m/s; 0: fixed, or nobody said
  std::vector<double> speed_;         // as stated, or as measured this tick where that is more, m/s
  // By object pair.
  std::vector<double> watch_below_;  // m; never less than 0
  std::vector<std::uint8_t> published_;
  std::vector<std::uint8_t> bin_;
  // Pairs, each list with room for all.
  std::vector<std::uint32_t> known_, scratch_;
};

}  // namespace clearance
