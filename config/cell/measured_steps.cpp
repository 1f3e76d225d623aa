#include "config/cell/measured_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "config/scene/absent_robots.hpp"
#include "config/text/spelling.hpp"

namespace clearance {
namespace {

constexpr double kFarthest = 1e3;   // m: no arm is as long
constexpr double kMostReach = 2.0;  // of the largest distance of a link from the axis
constexpr double kRounding = 1e-9;  // of the sum of a few masses

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

// Returns the mass of what stands on a robot, kg. A tool that is absent has none.
double mass_of(const Robot& robot, const ObjectList& list) {
  if (robot.is_attached) return list.objects[robot.links.front().object].mass;
  return is_absent(robot, list.objects) ? 0.0 : robot.mass;
}

// The mass that a robot carries, kg; nothing: something has none stated.
std::optional<double> carried(std::uint32_t robot, const RobotList& robots,
                              const ObjectList& list) {
  double mass = robots.robots[robot].stopping.load.tool;
  std::vector<bool> is_on_it(robots.robots.size(), false);
  is_on_it[robot] = true;
  for (std::size_t i = robot + 1; i < robots.robots.size(); ++i) {
    const Robot& of = robots.robots[i];
    is_on_it[i] = of.base.kind == RobotBase::Kind::kLink && is_on_it[of.base.robot];
    if (is_on_it[i]) mass += mass_of(of, list);
  }
  return std::isfinite(mass) ? std::optional(mass) : std::nullopt;
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
    if (stops.load.full > 0.0) {
      const double most = stops.steps.back().load;
      const auto mass = carried(i, robots, list);
      const double share = mass ? (1.0 - kRounding) * *mass / stops.load.full : most;
      const auto step = std::ranges::lower_bound(stops.steps, share, {}, &StopStep::load);
      if (step == stops.steps.end()) {
        const auto link = std::ranges::find_if(
            robot.links, [](const RobotLink& each) { return each.object != RobotLink::kNoObject; });
        if (link == robot.links.end()) continue;
        diagnostics.add(*list.places[link->object],
                        fmt::format("found {:g} kg on the robot '{}', {:.0f} % of its full load; "
                                    "expected at most {:g} %, the highest step of its stopping "
                                    "table",
                                    *mass, robot.name, 100.0 * share, 100.0 * most));
        continue;
      }
      const double chosen = step->load;
      stops.load.mass = mass.value_or(kInfinity);
      stops.load.step = chosen;
      std::erase_if(stops.steps, [&](const StopStep& each) { return each.load != chosen; });
    }
    stops.joints = stops.steps.back().joints;
    if (!(stops.extension.reach > 0.0)) stops.steps.clear();
  }
}

}  // namespace clearance
