// Reads a planning scene of MoveIt as YAML, as `ros2 topic echo --once --full-length` prints a
// moveit_msgs/PlanningScene.
#pragma once

#include <string>
#include <variant>

#include "config/moveit/message.hpp"

namespace clearance::moveit {

struct SceneYamlFault {
  int line, column;
  std::string reason;  // "found ...; expected ..."
};

// Reads one document; "---" may end it. A field that the message does not have is refused. Only the
// attached objects are read of the robot's state, and no colours, types and stamps. The first fault
// ends the reading.
[[nodiscard]] std::variant<PlanningScene, SceneYamlFault> read_scene_yaml(const std::string& text);

}  // namespace clearance::moveit
