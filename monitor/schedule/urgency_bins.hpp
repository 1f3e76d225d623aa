// How soon can a pair's distance fall below what somebody watches for? (§4.6)
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "monitor/schedule/evaluator.hpp"
#include "monitor/zones/zone_levels.hpp"

namespace clearance {

// Bins of active pairs in ticks, by stated and measured speeds. A pair is watched for its zones'
// thresholds and both margins, and at least for contact.
class UrgencyBins {
 public:
  // Bin b < kBins: fewer than 2^b ticks. At 1 kHz the last of them ends 8 ms ahead.
  static constexpr std::size_t kBins = 4;
  static constexpr double kTicks = 8.0;  // 2^(kBins - 1)

  // `levels` must outlive it.
  UrgencyBins(const Scene& scene, const std::vector<PosedPart>& parts, const ZoneLevels& levels);

  // By object, m: how far it comes within the ticks of all bins at its stated speed. A pair has to
  // be active well before it gets into a bin.
  [[nodiscard]] static std::vector<double> distances_ahead(const Scene& scene);

  // Evaluates the pairs seen in this tick that are in a bin, the nearest bin first.
  void evaluate(const Evaluator& evaluator) noexcept;

  // Of a pair that was brought up to date; kBins: none. What its bound does not prove outside its
  // zones is in the first.
  [[nodiscard]] std::size_t bin_of(std::uint32_t pair, const std::vector<TrackedObject>& objects,
                                   const PairTable& table) const noexcept;

 private:
  [[nodiscard]] double speed_of(std::uint32_t object, const TrackedObject& state) const noexcept;

  const ZoneLevels& levels_;
  const double period_s_;
  // By object.
  std::vector<double> reach_;          // no point of it is farther from its origin, m
  std::vector<double> stated_speed_;   // of any point of it, m/s; 0: fixed, or not stated
  std::vector<std::uint32_t> in_bin_;  // pairs of the bin that is being evaluated
};

}  // namespace clearance
