#include "monitor/interface/gradient_rows.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace clearance {
namespace {

using Joint = std::pair<std::uint32_t, std::uint32_t>;  // robot, joint

// The joints from a link to the world, or to the object that its robot stands on.
std::vector<Joint> chain_of(const Scene& scene, std::uint32_t robot, std::uint32_t link) {
  std::vector<Joint> chain;
  for (;;) {
    const Robot& of = scene.robots[robot];
    for (; link > 0; link = of.joints[link - 1].parent) {
      if (of.joints[link - 1].type != JointType::kFixed) chain.emplace_back(robot, link - 1);
    }
    if (of.base.kind != RobotBase::Kind::kLink) return chain;
    robot = of.base.robot;
    link = of.base.link;
  }
}

// Empty unless the object is a link.
std::vector<Joint> chain_of(const Scene& scene, std::uint32_t object) {
  for (std::uint32_t r = 0; r < scene.robots.size(); ++r) {
    const std::vector<RobotLink>& links = scene.robots[r].links;
    const auto found = std::ranges::find(links, object, &RobotLink::object);
    if (found == links.end()) continue;
    std::vector<Joint> chain =
        chain_of(scene, r, static_cast<std::uint32_t>(found - links.begin()));
    std::ranges::sort(chain);
    return chain;
  }
  return {};
}

}  // namespace

std::vector<MovingJoint> joints_between(const Scene& scene, const ObjectPair& pair) {
  const std::vector<Joint> a = chain_of(scene, pair.first), b = chain_of(scene, pair.second);
  std::vector<MovingJoint> joints;
  const auto add = [&joints](const std::vector<Joint>& joints_of_one,
                             const std::vector<Joint>& other, bool moves_b) {
    for (const Joint& joint : joints_of_one) {
      if (!std::ranges::binary_search(other, joint)) {
        joints.push_back({joint.first, joint.second, moves_b});
      }
    }
  };
  add(a, b, false);
  add(b, a, true);
  return joints;
}

GradientRows gradient_rows(const Scene& scene) {
  GradientRows found;
  if (!scene.gradients) return found;
  std::uint32_t published = 0;
  for (const ObjectPair& pair : scene.pairs) {
    if (!pair.publish) continue;
    std::vector<std::uint32_t> variables;
    for (const MovingJoint& moving : joints_between(scene, pair)) {
      const RobotJoint& joint = scene.robots[moving.robot].joints[moving.joint];
      for (std::uint32_t i = 0; i < variables_of(joint.type); ++i) {
        variables.push_back(joint.variable + i);
      }
    }
    std::ranges::sort(variables);
    variables.erase(std::ranges::unique(variables).begin(), variables.end());
    const auto first = static_cast<std::uint32_t>(found.variables.size());
    found.variables.insert(found.variables.end(), variables.begin(), variables.end());
    const auto end = static_cast<std::uint32_t>(found.variables.size());
    if (end > first) found.rows.push_back({published, first, end});
    ++published;
  }
  return found;
}

Gradients unknown_gradients(const GradientRows& rows) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  return {.rates = std::vector(rows.variables.size(), kUnknown),
          .drifts = std::vector(rows.rows.size(), kUnknown),
          .alternatives = std::vector(
              rows.rows.size(), GradientAlternative{GradientStatus::kUnknown, kUnknown, kUnknown})};
}

}  // namespace clearance
