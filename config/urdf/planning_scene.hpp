// Reads a planning scene of MoveIt in its text format (.scene), as its RViz panel exports it:
// obstacles made of boxes, spheres, cylinders, cones, meshes and planes.
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
      notes;  // what is not as in the file: meshes are hulls, planes half-spaces
};

struct PlanningSceneFault {
  int line;
  std::string reason;  // "found ...; expected ..."
};

// Lengths are in m. Both forms of the format: with the pose of each object, and the older one
// without. Colours and subframes are read and not kept.
[[nodiscard]] std::variant<PlanningScene, PlanningSceneFault> read_planning_scene(
    std::string_view text);

}  // namespace clearance
