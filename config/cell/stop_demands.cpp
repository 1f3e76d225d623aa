#include "config/cell/stop_demands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace clearance {
namespace {

// Returns, by object, whether joints move it: then its speed follows from theirs.
std::vector<bool> moved_by_joints(std::span<const Robot> robots, std::size_t objects) {
  std::vector<bool> found(objects, false), robot_on_object(robots.size(), false);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const RobotBase& base = robots[i].base;
    robot_on_object[i] = robots[i].is_attached &&
                         (base.kind == RobotBase::Kind::kObject ||
                          (base.kind == RobotBase::Kind::kLink && robot_on_object[base.robot]));
    if (robot_on_object[i]) continue;
    for (const RobotLink& link : robots[i].links)
      if (link.object != RobotLink::kNoObject) found[link.object] = true;
  }
  return found;
}

const YamlNode* value_of(const YamlNode& map, const char* key) {
  for (const YamlEntry& entry : map.entries)
    if (entry.key.text == key) return &entry.value;
  return nullptr;
}

}  // namespace

StoppingRobots::StoppingRobots(std::span<const Robot> robots, std::span<const Object> objects)
    : is_moved_(objects.size(), false) {
  std::vector<bool> is_moved_robot(robots.size(), false);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Robot& robot = robots[i];
    if (robot.stopping.is_stated() && first_ == nullptr) first_ = &robot;
    const bool stands_on_one =
        robot.base.kind == RobotBase::Kind::kLink && is_moved_robot[robot.base.robot];
    is_moved_robot[i] = robot.stopping.is_stated() || stands_on_one;
    if (!is_moved_robot[i]) continue;
    for (const RobotLink& link : robot.links)
      if (link.object != RobotLink::kNoObject && !objects[link.object].fixed)
        is_moved_[link.object] = true;
  }
}

void refuse_unbounded_motion(const StoppingRobots& stopping, const RobotList& robots,
                             const ObjectList& list, Diagnostics& diagnostics) {
  if (stopping.first() == nullptr) return;
  const std::string beside =
      fmt::format("beside the robot '{}' with 'stopping'", stopping.first()->name);
  const std::vector<bool> by_joints = moved_by_joints(robots.robots, list.objects.size());
  for (std::size_t i = 0; i < list.objects.size(); ++i) {
    const Object& object = list.objects[i];
    if (object.fixed || by_joints[i] || std::isfinite(object.max_speed)) continue;
    diagnostics.add(*list.places[i],
                    fmt::format("found '{}' without max_speed {}; expected its largest speed: it "
                                "could be anywhere while the robot stops",
                                object.name, beside));
  }
  for (const Robot& robot : robots.robots) {
    const auto limb = std::ranges::find_if(
        robot.links, [](const RobotLink& each) { return each.object != RobotLink::kNoObject; });
    if (robot.person && limb != robot.links.end()) {
      diagnostics.add(
          *list.places[limb->object],
          fmt::format("found the person '{}' {}; expected a tracked object with max_speed for "
                      "people: limbs have no limits, and could be anywhere while the robot stops",
                      robot.name, beside));
      continue;
    }
    if (robot.base.frame.empty()) continue;
    const std::uint32_t first = robot.joints.front().variable;
    const bool is_bounded = std::ranges::all_of(
        std::span(robots.variables).subspan(first, variables_of(JointType::kFloating)),
        [](const JointVariable& variable) { return std::isfinite(variable.max_speed); });
    if (is_bounded) continue;
    if (limb == robot.links.end()) continue;
    diagnostics.add(
        *list.places[limb->object],
        fmt::format("found the base of '{}' on the frame '{}' without max_speed and "
                    "max_turn_speed {}; expected both: it could be anywhere while the robot stops",
                    robot.name, robot.base.frame, beside));
  }
}

void refuse_zones_without_stops(const YamlNode& node, const StoppingRobots& stopping,
                                std::span<const Zone> zones, std::span<const ObjectPair> pairs,
                                Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < zones.size(); ++i) {
    const Zone& zone = zones[i];
    if (!zone.stop_margin || zone.pairs.empty()) continue;
    const bool has_one = std::ranges::any_of(zone.pairs, [&](std::uint32_t pair) {
      return stopping.move(pairs[pair].first) || stopping.move(pairs[pair].second);
    });
    if (has_one) continue;
    const YamlNode* stops = value_of(node.items[i], "stops");
    diagnostics.add(
        stops != nullptr ? *stops : node.items[i],
        fmt::format("found 'stops' of the zone '{}', in which nothing that moves belongs to a "
                    "robot with 'stopping'; expected a pair with a link of one (robots: [{{name: "
                    "arm, stopping: {{...}}}}])",
                    zone.name));
  }
}

}  // namespace clearance
