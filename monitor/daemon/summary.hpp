// What a person reads: names for pairs, figures of a run.
#pragma once

#include <string>

#include "config/scene.hpp"
#include "monitor/daemon/vitals.hpp"

namespace clearance {

// "left_link7 to shelf", with the part where an object has several: "left_hand.finger to shelf".
[[nodiscard]] std::string pair_name(const Scene& scene, const PairReport& pair);

// "p50 12.3 us  p99.9 45.6 us  max 78.9 us"
[[nodiscard]] std::string percentiles(const Histogram& histogram);

// Ticks, overruns, tick and wake-up times, the smallest distance seen. Ends with a newline.
[[nodiscard]] std::string run_summary(const Scene& scene, const Vitals& vitals, double seconds,
                                      std::uint64_t dropped_reports);

}  // namespace clearance
