// The URDF from ROS 2: robot_state_publisher's latched topic.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "monitor/app/stop_signal.hpp"
#include "monitor/participant/participant.hpp"

namespace clearance {

// Waits until the topic, "/robot_description", has a sample that is not empty, and logs the wait.
// Returns nothing when it was stopped.
[[nodiscard]] std::optional<std::string> wait_for_robot_description(Participant& participant,
                                                                    const std::string& ros_topic,
                                                                    StopSignal& stop);

// Keeps a URDF as a file for later replays, under a name that its text determines: in clearance/ of
// XDG_CACHE_HOME, else of ~/.cache, else of the folder for temporary files. Throws
// std::runtime_error when it cannot be written.
[[nodiscard]] std::filesystem::path keep_robot_description(const std::string& urdf);

}  // namespace clearance
