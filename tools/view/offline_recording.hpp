// A recording whose reports are computed here from the poses in another recording.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "config/cell/cell.hpp"

namespace clearance::view {

// Runs `recording` through the monitor and writes `out`: the poses in use and the report of every
// tick. Returns the fault, or an empty text. `stop` is called before every tick; true ends it
// there.
[[nodiscard]] std::string replay_into(const Cell& cell, const std::filesystem::path& recording,
                                      const std::filesystem::path& out,
                                      const std::function<void(double)>& progress,
                                      const std::function<bool()>& stop);

}  // namespace clearance::view
