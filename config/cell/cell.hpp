// All that a cell file says: the scene of the tick, and what only the programs around the tick
// need.
//
// Nothing of the tick includes this header: the monitor of a scene knows neither DDS nor ROS 2, nor
// where the scene stood.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "config/cell/ros_settings.hpp"
#include "config/cell/simulation.hpp"
#include "config/cell/topics.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

struct Cell {
  Scene scene = {};

  std::uint32_t domain = 0;      // DDS
  std::string partition = {};    // DDS; empty: the default partition
  std::string interface = "lo";  // DDS: a network card, or "default": as Cyclone chooses
  Topics topics = {};
  RosSettings ros = {};
  Simulation simulation = {};  // may be empty

  std::string yaml = {};  // the text that it was read from, for recordings
  // Where that text stood, and the files that it names, directly or not: meshes, URDF, SRDF,
  // planning scenes. Absolute; each once, in the order in which they were read.
  std::filesystem::path file = {};
  std::vector<std::filesystem::path> files = {};
};

// Whether `name` is a DDS partition that Clearance accepts: at most 255 bytes, empty for the
// default partition, and without wildcards, which would join cells that were to be kept apart.
[[nodiscard]] bool is_partition(const std::string& name) noexcept;

}  // namespace clearance
