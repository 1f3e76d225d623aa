// Draws the curves of a replay.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "tools/replay/run_series.hpp"

namespace clearance {

// Draws distances with their lower bounds, thresholds and times of zones, and closing speeds of
// these pairs. Returns an empty text, or the fault.
[[nodiscard]] std::string plot_run(const Scene& scene, const RunSeries& series,
                                   std::span<const std::size_t> places,
                                   const std::filesystem::path& svg);

}  // namespace clearance
