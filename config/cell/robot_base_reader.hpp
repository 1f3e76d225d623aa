// Reads the base of a robot in a cell file: the place or the frame that carries its root link.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/scene/robot.hpp"
#include "config/yaml/quantities.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// The poses in the world of links that nothing moves, by the names of the links.
using PosesAtRest = std::map<std::string, Pose>;

struct StatedBase {
  RobotBase base;
  // The limits and the source of a base that follows a frame.
  JointVariable limits;
  double max_turn_speed = kInfinity;  // rad/s
};

// Reads `base:`. It may stand on an object, or on a link of one of `robots`, which are the earlier
// robots of the cell. If nothing moves what it stands on, the base becomes a pose in the world.
[[nodiscard]] StatedBase read_robot_base(const YamlNode& node, const std::vector<Robot>& robots,
                                         const PosesAtRest& at_rest, const ObjectList& objects,
                                         const Quantities& quantities);

// Reads `attached:` of a robot, which says of a tool what `base:` with `on` says.
[[nodiscard]] RobotBase read_robot_attachment(const YamlNode& node,
                                              const std::vector<Robot>& robots,
                                              const PosesAtRest& at_rest, const ObjectList& objects,
                                              const Quantities& quantities);

// Reads the name of what something stands on: a link of one of `robots`, or an object. If nothing
// moves that, `base` becomes a pose in the world. `expected` ends the message about an unknown
// name.
void read_what_carries(const YamlNode& node, const std::vector<Robot>& robots,
                       const PosesAtRest& at_rest, const ObjectList& objects,
                       const std::string& expected, Diagnostics& diagnostics, RobotBase& base);

// Sets the limits of a base that follows a frame. The first seven variables are those of the
// floating joint that carries the base. An entry of a quaternion changes at most at half the rate
// of the rotation.
void limit_base(const StatedBase& stated, std::vector<JointVariable>& variables);

}  // namespace clearance
