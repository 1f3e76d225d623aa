// Reads the inputs that a monitor knows at its last tick.
#pragma once

#include "config/scene/scene.hpp"
#include "monitor/interface/present_inputs.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// The state before any tick: room for what a monitor knows of this scene.
[[nodiscard]] InputState room_for_inputs(const Scene& scene);

// Reads all but `cycle` and `now_ns`, between two ticks. The room is that of the monitor's scene.
// Allocates nothing.
void read_inputs(const Monitor& monitor, InputState& state) noexcept;

}  // namespace clearance
