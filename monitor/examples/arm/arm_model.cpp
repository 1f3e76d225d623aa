#include "monitor/examples/arm/arm_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace clearance::avoid {
namespace {

constexpr const char* kEndLink = "hand";

const Robot& only_robot(const Scene& scene) {
  if (scene.robots.size() == 1) return scene.robots.front();
  throw std::invalid_argument(
      fmt::format("the cell has {} robots; expected one", scene.robots.size()));
}

}  // namespace

ArmModel::ArmModel(const Scene& scene)
    : robot_(only_robot(scene)), states_(scene.variables.size()), kinematics_(scene.robots) {
  const auto end = std::ranges::find(robot_.links, kEndLink, &RobotLink::name);
  if (end == robot_.links.end()) {
    throw std::invalid_argument(
        fmt::format("the robot has no link '{}', which follows the path", kEndLink));
  }
  end_ = static_cast<std::uint32_t>(end - robot_.links.begin());
  for (std::uint32_t link = end_; link > 0; link = robot_.joints[link - 1].parent) {
    if (variables_of(robot_.joints[link - 1].type) == 1) joints_.push_back(link - 1);
  }
  std::ranges::reverse(joints_);
  for (const std::uint32_t joint : joints_) variables_.push_back(robot_.joints[joint].variable);
}

bool ArmModel::has(std::uint32_t object) const {
  return std::ranges::find(robot_.links, object, &RobotLink::object) != robot_.links.end();
}

void ArmModel::place(const std::vector<double>& positions) {
  for (std::size_t i = 0; i < states_.size(); ++i) {
    states_[i].input.has_value = true;
    states_[i].position = positions[i];
  }
  kinematics_.place(states_, {});
}

Vec3 ArmModel::end_point() const { return kinematics_.links(0)[end_].pose.position; }

Eigen::Matrix3Xd ArmModel::jacobian() const {
  Eigen::Matrix3Xd columns(3, joints_.size());
  const auto links = kinematics_.links(0);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const RobotJoint& joint = robot_.joints[joints_[i]];
    std::array<JointScrew, 1> screw;
    screws_of(joint, links[joint.parent], links[joints_[i] + 1], states_, screw);
    columns.col(static_cast<Eigen::Index>(i)) =
        screw[0].linear + screw[0].angular.cross(end_point() - screw[0].origin);
  }
  return columns;
}

}  // namespace clearance::avoid
