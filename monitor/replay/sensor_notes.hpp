// The sensors of a replay, in words.
#pragma once

#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/sensors/sensors.hpp"

namespace clearance {

// Says what each sensor has seen, which of its messages were refused, and how much the robot's own
// image may hide.
[[nodiscard]] std::vector<std::string> sensor_notes(const Sensors& sensors, const Scene& scene);

}  // namespace clearance
