// How the robots of a cell stop, as the cell states it.
#pragma once

#include <string>

#include "config/scene/scene.hpp"

namespace clearance {

// By joint: how far and how long it goes on from some speeds. Empty: the cell states no stops.
[[nodiscard]] std::string stop_table(const Scene& scene);

// A script for gnuplot: the distance of each joint over its speed.
[[nodiscard]] std::string stop_plot(const Scene& scene);

}  // namespace clearance
