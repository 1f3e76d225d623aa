// Reads a planning scene of MoveIt in its text format (.scene), as its RViz panel exports it:
// boxes, spheres, cylinders, cones, meshes and planes.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

struct PlanningScene {
  std::string name;
  std::vector<Object> objects;  // fixed, without groups
  std::vector<std::string>
      notes;  // differences from the file: meshes are hulls, planes half-spaces
};

struct PlanningSceneFault {
  int line;
  std::string reason;  // "found ...; expected ..."
};

// Reads both forms of the format: with the pose of each object, and the older one without. Lengths
// are in m. Colours and subframes are skipped.
[[nodiscard]] std::variant<PlanningScene, PlanningSceneFault> read_planning_scene(
    std::string_view text);

}  // namespace clearance
