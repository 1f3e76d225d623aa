// The curves of a replay as a picture.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "tools/replay/run_series.hpp"

namespace clearance {

// Distances with their lower bounds, thresholds and times of zones, and closing speeds of these
// pairs. Empty, or what went wrong.
[[nodiscard]] std::string plot_run(const Scene& scene, const RunSeries& series,
                                   std::span<const std::size_t> places,
                                   const std::filesystem::path& svg);

}  // namespace clearance
