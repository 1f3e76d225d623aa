// Reads `ros2:` of a cell file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/cell/ros_settings.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

void read_ros(const YamlNode& node, const Quantities& quantities, RosSettings& settings);

// Reads "message" or "sent"; anything else is reported and counts as the former.
[[nodiscard]] RosStamps read_stamps(const YamlNode& node, Diagnostics& diagnostics);

// Reads the name of a topic of ROS 2, with its namespace, such as `example`. Empty after a
// diagnostic.
[[nodiscard]] std::string read_ros_topic(const YamlNode& node, std::string_view example,
                                         Diagnostics& diagnostics);

// Reads the name of a frame of tf, without the slash in front that some write; returns nothing
// after a diagnostic.
[[nodiscard]] std::optional<std::string> read_frame(const YamlNode& node, Diagnostics& diagnostics);

}  // namespace clearance
