// The content of a cell file: the scene of the tick, and the settings of the programs around it.
//
// No code of the tick includes this header: the tick knows neither DDS nor ROS 2, nor the files of
// the cell.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/command_settings.hpp"
#include "config/cell/plc_settings.hpp"
#include "config/cell/ros_settings.hpp"
#include "config/cell/shares.hpp"
#include "config/cell/simulation.hpp"
#include "config/cell/topics.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

struct Cell {
  Scene scene = {};

  std::optional<std::uint32_t> domain = {};  // DDS; none: as DdsOptions
  std::string partition = {};                // DDS; empty: the default partition
  std::string interface = {};                // DDS; empty: as DdsOptions
  Topics topics = {};
  // Reports carry the pairs that changed, and all pairs once in this time, s; 0: always all.
  double full_every_s = 0.0;
  RosSettings ros = {};
  CommandSettings commands = {};
  QuestionSettings questions = {};
  PlcSettings plc = {};
  AddedCapacity capacity = {};
  std::string partner = {};    // the daemon's name among partners; empty: it has none
  Simulation simulation = {};  // may be empty
  Shares shares = {};          // likewise

  std::string yaml = {};  // the text of the cell, for recordings
  // The file of that text, and the files that it names, directly or not: meshes, URDF, SRDF,
  // planning scenes. Absolute; each once, in the order in which they were read.
  std::filesystem::path file = {};
  std::vector<std::filesystem::path> files = {};
  std::vector<std::string> file_hashes = {};  // SHA-256 of each of these
  // SHA-256 of all that the revision covers: the digests of the text without the partner's name, of
  // each file, and of what meshes were split into, in the order in which they were read.
  std::string hash = {};
};

// Tells whether `name` is a DDS partition that Clearance accepts: at most 255 bytes, without
// wildcards; empty is the default partition. Wildcards would join cells that must stay separate.
[[nodiscard]] bool is_partition(const std::string& name) noexcept;

}  // namespace clearance
