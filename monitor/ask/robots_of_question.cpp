#include "monitor/ask/robots_of_question.hpp"

#include <cstdint>
#include <optional>

#include "monitor/ask/trajectory.hpp"

namespace clearance {

std::vector<bool> robots_of_question(const Scene& scene, const Question& question) {
  const auto root = [&](std::uint32_t robot) {
    while (scene.robots[robot].base.kind == RobotBase::Kind::kLink)
      robot = scene.robots[robot].base.robot;
    return robot;
  };
  std::vector<bool> moves(scene.robots.size(), false), result(scene.robots.size(), false);
  const auto note = [&](const JointTrajectory& motion) {
    for (const std::string& joint : motion.joints) {
      const std::optional<std::uint32_t> variable = variable_named(scene, joint);
      if (variable) moves[root(scene.variables[*variable].robot)] = true;
    }
  };
  note(question.motion);
  for (const JointTrajectory& motion : question.beside) note(motion);
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) result[r] = moves[root(r)];
  return result;
}

}  // namespace clearance
