// Reads where the sensors of a cell are mounted, and computes what they crop to.
#pragma once

#include "config/cell/robot_reader.hpp"
#include "config/cell/sensor_reader.hpp"

namespace clearance {

// Reads where the sensors are mounted, once all robots and attached objects are known.
void mount_sensors(const RobotList& robots, const ObjectList& objects, const Quantities& quantities,
                   SensorList& list);

// Computes the balls to which sensors crop, once the scene has all else.
void crop_sensors(const SensorList& list, Diagnostics& diagnostics, Scene& scene);

}  // namespace clearance
