// The sensors of a replay, in words.
#pragma once

#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/recording/input_log.hpp"
#include "monitor/sensors/sensors.hpp"

namespace clearance {

// A sentence for each sensor that sent nothing. Every distance to it is unknown: its topic may
// be spelt wrongly, so the topics of such sensors in a bag are listed. Null: the cell has no
// sensors, or the inputs are a recording of our own.
[[nodiscard]] std::vector<std::string> unheard_sensors(const Sensors* sensors, const Scene& scene,
                                                       const InputLog* log);

// Says what each sensor has seen, which of its messages were refused, and how much the robot's own
// image may hide. It leaves out the sensors that sent nothing.
[[nodiscard]] std::vector<std::string> sensor_notes(const Sensors& sensors, const Scene& scene);

}  // namespace clearance
