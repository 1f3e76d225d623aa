// Reads `scenes:` of a cell: the obstacles of MoveIt's planning scenes as fixed objects.
#pragma once

#include <filesystem>

#include "config/cell/object_reader.hpp"
#include "config/cell/pair_reader.hpp"
#include "config/cell/shape_reader.hpp"
#include "config/scene/revision.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// A file ends in .scene, MoveIt's text, or in .yaml or .yml, a moveit_msgs/PlanningScene. Adds the
// obstacles behind the objects of the list, and states what is attached to links. Files are
// relative to `directory`; their bytes go into the revision.
void read_planning_scenes(const YamlNode& node, const std::filesystem::path& directory,
                          const ObjectDefaults& defaults, const Quantities& quantities,
                          ShapeReader& shapes, Revision& revision, ObjectList& list);

// Adds the pairs that the collision matrices of planning scenes allow, once all objects are known.
void allow_by_matrices(const ObjectList& list, PairExceptions& may_touch);

}  // namespace clearance
