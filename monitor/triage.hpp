// Which pairs are evaluated this tick? (§4.6)
//
// Every bound is true before and after; triage decides only how tight it is. When the budget covers
// all rows of known pairs, all are evaluated. When it does not:
//  1. the minimum: in order of carried lower bound, until none left can beat the smallest upper
//  bound;
//  2. bins by the number of ticks until a row's distance can fall below what somebody watches for
//  (a
//     zone's threshold and both margins, at least contact), by stated and measured speeds: the
//     first bins every tick, nearest first. What a carried bound does not prove outside its zones
//     is in the first bin, a published pair no later than in the last of these;
//  3. the rest round-robin, stalest first.
// Order and outcome depend on the inputs only: no clock, no addresses.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/pair_table.hpp"

namespace clearance {

class Triage {
 public:
  Triage(const Scene& scene, const PairTable& table);

  // Evaluates what is due; returns how many queries that took, at most Scene::budget.
  std::uint32_t evaluate_due(const std::vector<ObjectState>& objects,
                             const std::vector<PlacedPart>& parts, std::uint64_t cycle,
                             PairTable& table) noexcept;

 private:
  // Bin b < kUrgentBins: fewer than 2^b ticks; the one after them is the rest. At 1 kHz the last
  // urgent bin ends 8 ms ahead.
  static constexpr std::size_t kUrgentBins = 4;
  static constexpr std::size_t kBins = kUrgentBins + 1;

  // What all steps of one tick work on.
  struct Work {
    const std::vector<ObjectState>& objects;
    const std::vector<PlacedPart>& parts;
    const std::uint64_t cycle;
    PairTable& table;
    std::uint32_t queries_left;
  };

  void find_known(const Work& work) noexcept;
  void evaluate_closest(Work& work) noexcept;
  void evaluate_by_bins(Work& work) noexcept;
  void evaluate_stalest(std::span<std::uint32_t> rows, Work& work) noexcept;
  [[nodiscard]] std::size_t bin_of(std::uint32_t row, const Work& work) const noexcept;

  const std::uint32_t budget_;
  const double period_s_;
  std::vector<double> watch_below_;  // by object pair, m: never less than 0
  std::vector<bool> published_;      // by object pair
  // Rows, each list with room for all.
  std::vector<std::uint32_t> known_, scratch_;
  std::vector<std::uint8_t> bins_;  // by row
};

}  // namespace clearance
