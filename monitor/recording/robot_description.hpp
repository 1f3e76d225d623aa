// The URDF in a bag, from the topic robot_description that robot_state_publisher latches.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace clearance {

// Returns the first description in any namespace. A bag without one is read to its end.
[[nodiscard]] std::optional<std::string> robot_description(const std::filesystem::path& bag);

}  // namespace clearance
