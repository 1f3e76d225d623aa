// The URDF that a bag holds: the topic robot_description, which robot_state_publisher latches.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace clearance {

// The first one, of any namespace. Reads until there is one: through all of a bag that has none.
[[nodiscard]] std::optional<std::string> robot_description(const std::filesystem::path& bag);

}  // namespace clearance
