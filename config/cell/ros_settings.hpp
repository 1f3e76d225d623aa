// What a cell has to do with ROS 2 beyond joint states: the topics that are written for it, and how
// its frames belong to the cell.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "config/scene/ros_stamps.hpp"

namespace clearance {

// Topics as ROS 2 calls them, "/diagnostics"; an empty one is not written.
struct RosOutputs {
  std::string markers, diagnostics, minimum_distance, speed_scaling;
};

// One row an output: its key in a cell, and the topic that it has where none is named.
struct RosOutput {
  std::string_view key;
  std::string RosOutputs::*topic;
  std::string_view standard_topic;
};
inline constexpr std::array<RosOutput, 4> kRosOutputs = {{
    {"markers", &RosOutputs::markers, "/clearance/markers"},
    {"diagnostics", &RosOutputs::diagnostics, "/diagnostics"},
    {"minimum_distance", &RosOutputs::minimum_distance, "/clearance/minimum_distance"},
    {"speed_scaling", &RosOutputs::speed_scaling, "/clearance/speed_scaling"},
}};

struct RosSettings {
  RosOutputs outputs;
  double markers_hz = 30.0;
  // The frame of tf that is the cell's world; not empty where something follows a frame. Empty:
  // "world" in what is written.
  std::string world_frame;
  RosStamps stamps = RosStamps::kMessage;  // of tf

  [[nodiscard]] std::string world() const { return world_frame.empty() ? "world" : world_frame; }
};

// Whether `name` is a topic of ROS 2: "/" and names of letters, digits and "_" that begin with no
// digit, with "/" between them.
[[nodiscard]] bool is_ros_topic(std::string_view name) noexcept;

}  // namespace clearance
