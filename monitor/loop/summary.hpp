// The figures of a run as text for a person.
#pragma once

#include <string>

#include "config/scene/scene.hpp"
#include "monitor/loop/loop_statistics.hpp"

namespace clearance {

// "p50 12.3 us  p99.9 45.6 us  max 78.9 us"
[[nodiscard]] std::string percentiles(const Histogram& histogram);

// Lists ticks, overruns, tick times and wake-up times. Ends with a newline.
[[nodiscard]] std::string run_summary(const RunStatistics& statistics, double seconds,
                                      std::uint64_t dropped_reports);

// Says the smallest distance that was seen. `scene` is the scene in which it was measured. Ends
// with a newline.
[[nodiscard]] std::string minimum_text(const MinimumSeen& minimum, const Scene& scene);

}  // namespace clearance
