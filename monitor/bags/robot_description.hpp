// The URDF that a bag holds: the topic robot_description, which robot_state_publisher latches.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace clearance {

// The first one, of any namespace. Reads until there is one: through all of a bag that has none.
[[nodiscard]] std::optional<std::string> robot_description(const std::filesystem::path& bag);

// The same text in a file, for those who read URDFs from files: in a folder of this user's for
// temporary files, under a name that the text alone decides, so that the same bag gives the same
// cell. It stays there. `error` says why there is none: the bag has no description, or the file
// cannot be made.
[[nodiscard]] std::optional<std::filesystem::path> robot_description_file(
    const std::filesystem::path& bag, std::string& error);

}  // namespace clearance
