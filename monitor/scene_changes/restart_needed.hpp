// What may not change while the daemon runs.
#pragma once

#include <optional>
#include <string>

#include "config/cell/cell.hpp"
#include "monitor/loop/scene_capacity.hpp"

namespace clearance {

// Returns why the cell `now` cannot follow `before` in a running daemon, as the end of a sentence:
// "the rate changes from 1000 to 500 Hz, which takes a restart". Nothing: it can.
[[nodiscard]] std::optional<std::string> restart_needed(const Cell& before, const Cell& now,
                                                        const SceneCapacity& capacity);

}  // namespace clearance
