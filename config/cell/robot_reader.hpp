// Reads the robots of a cell file: their links become objects, their joints the tree that moves
// them.
#pragma once

#include <filesystem>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/cell/pair_reader.hpp"
#include "config/cell/robot_base_reader.hpp"
#include "config/cell/shape_reader.hpp"
#include "config/scene/revision.hpp"
#include "config/scene/robot.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

struct RobotList {
  std::vector<Robot> robots;
  std::vector<JointVariable> variables;
  PairExceptions may_touch;  // by the SRDFs, or, without one, neighbours
  PosesAtRest at_rest;       // of all links that nothing moves
};

// Reads `robots:` of the cell `file`. Every link with collision shapes is appended to `objects`, in
// the group of its robot's name; a link that nothing moves is fixed. The bytes of URDF and SRDF go
// into `revision`.
[[nodiscard]] RobotList read_robots(const YamlNode& node, const std::filesystem::path& file,
                                    const ObjectDefaults& defaults, const Quantities& quantities,
                                    ShapeReader& shapes, Revision& revision, ObjectList& objects);

}  // namespace clearance
