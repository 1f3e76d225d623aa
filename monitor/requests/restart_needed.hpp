// Finds changes of a scene that need a restart of the daemon, or exceed its capacity.
#pragma once

#include <optional>
#include <string>

#include "config/cell/cell.hpp"
#include "monitor/loop/scene_capacity.hpp"

namespace clearance {

// Returns why the cell `now` cannot follow `before` in a running daemon, as the end of a sentence:
// "the rate changes from 1000 to 500 Hz, which takes a restart". Nothing: it can.
[[nodiscard]] std::optional<std::string> restart_needed(const Cell& before, const Cell& now);

// Returns why the running daemon has no memory for this cell, with the numbers: "it has 70 objects,
// and 66 are the most that the daemon was started for (capacity: objects)". Nothing: it has.
[[nodiscard]] std::optional<std::string> beyond_capacity(const Cell& now,
                                                         const SceneCapacity& capacity);

}  // namespace clearance
