// The figures of a run as text for a person.
#pragma once

#include <initializer_list>
#include <string>
#include <utility>

#include "config/scene/scene.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/loop/response_times.hpp"

namespace clearance {

// "p50 12.3 us  p99.9 45.6 us  max 78.9 us"
[[nodiscard]] std::string percentiles(const Histogram& histogram);

// A JSON object of each of these, by name: {"count", "max_ns", "bins": [[upper edge in ns,
// count]]}.
[[nodiscard]] std::string histograms_json(
    std::initializer_list<std::pair<const char*, Histogram>> histograms);

// Lists ticks, overruns, tick times, wake-up times and response times. Ends with a newline.
[[nodiscard]] std::string run_summary(const RunStatistics& statistics,
                                      const ResponseTimes& responses, double seconds,
                                      std::uint64_t dropped_reports);

// Says the smallest distance that was seen. `scene` is the scene in which it was measured. Ends
// with a newline.
[[nodiscard]] std::string minimum_text(const MinimumSeen& minimum, const Scene& scene);

}  // namespace clearance
