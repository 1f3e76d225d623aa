#include "config/scene/attached.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/scene/absent_robots.hpp"
#include "config/scene/chain_rounding.hpp"
#include "config/scene/rigid_root.hpp"

namespace clearance {
namespace {

constexpr double kRounding = 1e-9;  // of the sum of a few masses

bool is_unbounded(const Object& object) {
  return !std::ranges::all_of(object.parts, [](const Part& part) { return part.shape.bounded(); });
}

void join(const std::vector<std::string>& groups, Object& object) {
  for (const std::string& group : groups) {
    if (std::ranges::find(object.groups, group) == object.groups.end())
      object.groups.push_back(group);
  }
}

// Returns the mass of what stands on a robot, kg. A tool that is absent has none.
double mass_of(const Robot& robot, std::span<const Object> objects) {
  if (robot.is_attached) return objects[robot.links.front().object].mass;
  return is_absent(robot, objects) ? 0.0 : robot.mass;
}

// The mass that a robot carries, kg; nothing: something has none stated.
std::optional<double> carried(std::uint32_t robot, std::span<const Robot> robots,
                              std::span<const Object> objects) {
  double mass = robots[robot].stopping.load.tool;
  std::vector<bool> is_on_it(robots.size(), false);
  is_on_it[robot] = true;
  for (std::size_t i = robot + 1; i < robots.size(); ++i) {
    const Robot& of = robots[i];
    is_on_it[i] = of.base.kind == RobotBase::Kind::kLink && is_on_it[of.base.robot];
    if (is_on_it[i]) mass += mass_of(of, objects);
  }
  return std::isfinite(mass) ? std::optional(mass) : std::nullopt;
}

}  // namespace

void take_over(const Object& carrier, Object& object) {
  join(carrier.groups, object);
  object.absent = object.absent || carrier.absent;
  object.age_limit_ns = carrier.age_limit_ns;
  object.may_jump = carrier.may_jump;
  object.approach_speed = carrier.approach_speed;
}

void take_over(const Robot& carrier, std::span<const Object> objects, Object& object) {
  std::vector<std::string> groups = {carrier.name};
  double speed = 0.0;  // of its fastest link
  for (const RobotLink& link : carrier.links) {
    if (link.object == RobotLink::kNoObject) continue;
    const Object& shaped = objects[link.object];
    groups = shaped.groups;
    object.absent = object.absent || shaped.absent;
    speed = std::max(speed, shaped.approach_speed);
  }
  if (speed > 0.0) object.approach_speed = speed;
  join(groups, object);
}

void be_carried(const RobotBase& base, std::uint32_t index, std::vector<Robot>& robots,
                const std::vector<JointVariable>& variables, Object& object) {
  Robot robot;
  robot.name = object.name;
  robot.is_attached = true;
  robot.base = base;
  robot.links.push_back({.name = object.name, .object = index});
  robots.push_back(std::move(robot));
  const auto last = static_cast<std::uint32_t>(robots.size() - 1);
  if (!root_of_link(robots, last, 0).is_object) object.max_speed = kInfinity;
  account_for(chain_rounding(robots, variables).front(), object);
}

std::vector<std::uint32_t> carriers_of(std::span<const Attachment> attachments,
                                       std::size_t objects) {
  std::vector<std::uint32_t> carriers(objects, kNoCarrier);
  for (const Attachment& each : attachments) carriers[each.object] = each.carrier;
  return carriers;
}

bool is_named(const Object& object, const std::string& name) {
  return object.name == name || std::ranges::count(object.groups, name) > 0;
}

bool never_meet(const Object& a, const Object& b) {
  if (a.is_seen() || b.is_seen())
    return (a.is_seen() && b.is_seen()) || is_unbounded(a) || is_unbounded(b);
  return a.fixed && b.fixed;
}

std::string on_both_sides(const Object& person) {
  return fmt::format(
      "found '{}' on both sides of the zone; expected people on one and the robot on the other",
      person.name);
}

std::optional<std::string> choose_steps(std::uint32_t index, std::span<const Object> objects,
                                        std::vector<Robot>& robots) {
  RobotStops& stops = robots[index].stopping;
  const double most = stops.load.steps.back().load;
  const auto mass = carried(index, robots, objects);
  const double share = mass ? (1.0 - kRounding) * *mass / stops.load.full : most;
  const auto step = std::ranges::lower_bound(stops.load.steps, share, {}, &StopStep::load);
  if (step == stops.load.steps.end()) {
    return fmt::format(
        "found {:g} kg on the robot '{}', {:.0f} % of its full load; expected at most {:g} %, the "
        "highest step of its stopping table",
        *mass, robots[index].name, 100.0 * share, 100.0 * most);
  }
  stops.load.mass = mass.value_or(kInfinity);
  stops.load.step = step->load;
  stops.steps.clear();
  std::ranges::copy_if(stops.load.steps, std::back_inserter(stops.steps),
                       [&](const StopStep& each) { return each.load == stops.load.step; });
  stops.joints = stops.steps.back().joints;
  if (!(stops.extension.reach > 0.0)) stops.steps.clear();
  return std::nullopt;
}

}  // namespace clearance
