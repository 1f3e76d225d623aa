// The URDF of a robot from robot_state_publisher's latched topic in ROS 2.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "monitor/app/stop_signal.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance {

// Waits until the topic, "/robot_description", has a sample that is not empty, and logs the wait.
// Returns nothing if `stop` ended the wait.
[[nodiscard]] std::optional<std::string> wait_for_robot_description(Participant& participant,
                                                                    const std::string& ros_topic,
                                                                    StopSignal& stop);

// Stores a URDF as a file for later replays, under a name that its text determines. The folder is
// clearance/ in XDG_CACHE_HOME, else in ~/.cache, else in the folder for temporary files. Throws
// std::runtime_error if the file cannot be written.
[[nodiscard]] std::filesystem::path keep_robot_description(const std::string& urdf);

}  // namespace clearance
