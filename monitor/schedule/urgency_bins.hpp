// Sorts pairs by the time until their distance can fall below a watched level (§4.6).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "monitor/schedule/evaluator.hpp"
#include "monitor/zones/zone_levels.hpp"

namespace clearance {

// Bins of active pairs by the number of ticks that their distance needs to fall to its level, at
// stated and measured speeds. The level of a pair is the largest threshold of its zones, margins
// included, and at least contact.
class UrgencyBins {
 public:
  // Bin b < kBins: fewer than 2^b ticks. At 1 kHz the last bin ends 8 ms ahead.
  static constexpr std::size_t kBins = 4;
  static constexpr double kTicks = 8.0;  // 2^(kBins - 1)

  // `levels` must outlive it. `in_bin` has capacity for all pairs; between two calls its content
  // may change.
  UrgencyBins(const Scene& scene, const ZoneLevels& levels, std::vector<std::uint32_t>& in_bin);

  // By object, m: how far it moves within the ticks of all bins at its stated speed. A pair must be
  // active well before it is in a bin.
  [[nodiscard]] static std::vector<double> distances_ahead(const Scene& scene);

  // Evaluates the updated pairs that are in a bin, the nearest bin first.
  void evaluate_urgent(const Evaluator& evaluator) noexcept;

  // The bin of an updated pair; kBins: none. A pair that its bound does not prove to be outside its
  // zones is in the first.
  [[nodiscard]] std::size_t bin_of(std::uint32_t pair, const TickView& view) const noexcept;

 private:
  [[nodiscard]] double speed_of(std::uint32_t object, const TrackedObject& state) const noexcept;

  const ZoneLevels& levels_;
  const double period_s_;
  std::vector<double> stated_speed_;    // by object, of any point, m/s; 0: fixed, or not stated
  std::vector<std::uint32_t>& in_bin_;  // pairs of the bin that is being evaluated
};

}  // namespace clearance
