// The looks of a robot's links, for pictures only: <visual> of URDF.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/urdf/urdf.hpp"

namespace clearance {

struct UrdfVisual {
  std::string link;
  UrdfCollision shape;
  std::optional<Vec3> colour;  // red, green, blue from 0 to 1; nothing: the file states none
};

// Returns the visual shapes of all links, in the order of the file. Nothing is refused: a shape
// that cannot be read is left out, and so are all shapes of a file that cannot be read.
[[nodiscard]] std::vector<UrdfVisual> read_visuals(const std::filesystem::path& urdf);

}  // namespace clearance
