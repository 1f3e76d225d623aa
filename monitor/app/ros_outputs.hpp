// The option "--ros2" of programs that write for ROS 2.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "config/cell/ros_settings.hpp"

namespace clearance {

// Adds the option, which may be repeated. `asked` gets the keys of outputs, or "all".
CLI::Option* add_ros_outputs(CLI::App& app, std::vector<std::string>& asked);

// Gives each output that is asked for its standard topic. A topic that the cell names stays.
void add_asked(const std::vector<std::string>& asked, RosOutputs& outputs);

}  // namespace clearance
