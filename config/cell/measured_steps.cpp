#include "config/cell/measured_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "config/scene/attached.hpp"
#include "config/text/spelling.hpp"

namespace clearance {
namespace {

constexpr double kFarthest = 1e3;   // m: no arm is as long
constexpr double kMostReach = 2.0;  // of the largest distance of a link from the axis

// The longest that the origin of a joint's child is from that of its parent, m.
double longest_step(const RobotJoint& joint, std::span<const JointVariable> variables) {
  const double fixed = joint.parent_from_joint.position.norm();
  if (joint.type != JointType::kPrismatic) return fixed;
  const JointVariable& variable = variables[joint.variable];
  const double slides =
      std::max(std::abs(variable.lower), std::abs(variable.upper)) + variable.limit_tolerance;
  return fixed + std::abs(joint.multiplier) * slides + std::abs(joint.offset);
}

// The joint whose position moves this one: itself, or the one that it mimics.
std::size_t mover_of(const Robot& robot, std::span<const JointVariable> variables,
                     std::size_t joint) {
  const std::string& name = variables[robot.joints[joint].variable].name;
  const auto found = std::ranges::find(robot.joints, name, &RobotJoint::name);
  return static_cast<std::size_t>(found - robot.joints.begin());
}

bool turns(const RobotJoint& joint) {
  return joint.type == JointType::kRevolute || joint.type == JointType::kContinuous;
}

// The joints from the first one that turns to the link; empty: none turns.
std::vector<std::size_t> chain_to(const Robot& robot, std::size_t link) {
  std::vector<std::size_t> chain;
  std::size_t length = 0;  // up to the lowest joint that turns
  for (; link > 0; link = robot.joints[link - 1].parent) {
    const RobotJoint& joint = robot.joints[link - 1];
    if (robot.is_of_base(joint.variable) && joint.type != JointType::kFixed) break;
    chain.push_back(link - 1);
    if (turns(joint)) length = chain.size();
  }
  chain.resize(length);
  std::ranges::reverse(chain);
  return chain;
}

}  // namespace

std::variant<Extension, std::string> measured_extension(const Robot& robot,
                                                        std::span<const JointVariable> variables,
                                                        const std::string& link, double reach) {
  const auto found = std::ranges::find(robot.links, robot.prefix + link, &RobotLink::name);
  if (found == robot.links.end()) {
    std::vector<std::string> names;
    for (const RobotLink& each : robot.links)
      names.push_back(each.name.substr(robot.prefix.size()));
    return fmt::format("found the link '{}'; expected one of the robot '{}'{}", link, robot.name,
                       did_you_mean(link, names));
  }
  Extension extension;
  extension.reach = reach;
  extension.link = static_cast<std::uint32_t>(found - robot.links.begin());
  const std::vector<std::size_t> chain = chain_to(robot, extension.link);
  if (chain.size() < 2)
    return fmt::format(
        "found '{}', which no joint moves away from an axis; expected a link behind "
        "a joint that turns and another one",
        link);
  extension.joint = static_cast<std::uint32_t>(chain.front());
  extension.levers.assign(robot.joints.size(), 0.0);
  double lever = 0.0;
  for (std::size_t i = chain.size() - 1; i > 0; --i) {
    const RobotJoint& joint = robot.joints[chain[i]];
    if (joint.type != JointType::kFixed) {
      const double per_unit = turns(joint) ? lever : 1.0;
      extension.levers[mover_of(robot, variables, chain[i])] +=
          std::abs(joint.multiplier) * per_unit;
    }
    lever += longest_step(joint, variables);
  }
  if (!(lever < kFarthest))
    return fmt::format("found '{}' behind a joint that slides without limits; expected limits",
                       link);
  if (reach <= kMostReach * lever) return extension;
  return fmt::format(
      "found a reach of {:.4g} m; expected at most {:g} times {:.4g} m, as '{}' comes "
      "no farther from the axis of '{}': is a unit wrong?",
      reach, kMostReach, lever, link,
      robot.joints[extension.joint].name.substr(robot.prefix.size()));
}

std::vector<StopConditions> measured_steps(std::span<const std::vector<StopRow>> of_joint,
                                           const StopConditions& stated, bool is_load_measured,
                                           bool is_extension_measured) {
  std::set<std::optional<double>> loads, extensions;
  for (const std::vector<StopRow>& rows : of_joint) {
    for (const StopRow& row : rows) {
      if (row.category >= 0 && row.category != stated.category) continue;
      loads.insert(is_load_measured ? row.load : stated.load);
      extensions.insert(is_extension_measured ? row.extension : stated.extension);
    }
  }
  std::vector<StopConditions> steps;
  for (const auto& load : loads)
    for (const auto& extension : extensions) steps.push_back({stated.category, load, extension});
  return steps;
}

void use_carried_loads(const ObjectList& list, RobotList& robots, Diagnostics& diagnostics) {
  for (std::uint32_t i = 0; i < robots.robots.size(); ++i) {
    Robot& robot = robots.robots[i];
    RobotStops& stops = robot.stopping;
    if (stops.steps.empty()) continue;
    if (!(stops.load.full > 0.0)) {
      stops.joints = stops.steps.back().joints;
      continue;
    }
    stops.load.steps = std::move(stops.steps);
    const auto why = choose_steps(i, list.objects, robots.robots);
    const auto link = std::ranges::find_if(
        robot.links, [](const RobotLink& each) { return each.object != RobotLink::kNoObject; });
    if (why && link != robot.links.end()) diagnostics.add(*list.places[link->object], *why);
  }
}

}  // namespace clearance
