// The option "--ros2" of programs that write for ROS 2.
#pragma once

#include <string>
#include <vector>

#include "config/cell/ros_settings.hpp"
#include "monitor/app/command_line.hpp"

namespace clearance {

// The option may be repeated. `asked` gets the keys of outputs, or "all". `excludes` as in
// OptionRule.
[[nodiscard]] Option ros_outputs_option(std::vector<std::string>& asked,
                                        std::vector<std::string> excludes = {});

// Gives each output that is asked for its standard topic. A topic that the cell names stays.
void add_asked(const std::vector<std::string>& asked, RosOutputs& outputs);

}  // namespace clearance
