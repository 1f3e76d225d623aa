// The reason why a zone is active, as text for all programs.
#pragma once

#include <algorithm>
#include <string>

#include "config/scene/rigid_root.hpp"
#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

// The inputs that place an object. A link of a robot that is driven by joints has joint states, not
// poses, and what a sensor sees has images.
enum class PlacedBy { kPoses, kJointStates, kEither, kFrames };

// "poses of hand".
[[nodiscard]] inline std::string inputs_of(const std::string& object, PlacedBy placed_by) {
  switch (placed_by) {
    case PlacedBy::kPoses:
      return "poses of " + object;
    case PlacedBy::kJointStates:
      return "joint states for " + object;
    case PlacedBy::kEither:
      return "poses or joint states of " + object;
    case PlacedBy::kFrames:
      return "usable images of " + object;
  }
  return object;
}

// Returns, for example, "by distance" or "poses of hand are late", or an empty text if the zone is
// not active. `object` is the name of ZoneReport::cause_object.
[[nodiscard]] inline std::string cause_text(ZoneCause cause, const std::string& object,
                                            PlacedBy placed_by) {
  const std::string inputs = inputs_of(object, placed_by);
  switch (cause) {
    case ZoneCause::kInactive:
      return "";
    case ZoneCause::kNear:
      return "by distance";
    case ZoneCause::kLate:
      return inputs + " are late";
    case ZoneCause::kUnknown:
      return "no " + inputs + " have come";
    case ZoneCause::kDiscontinuous:
      return inputs + " are discontinuous";
    case ZoneCause::kContradicted:
      return inputs + " contradict each other or the cell";
    case ZoneCause::kContactTooDeep:
      return "a contact is deeper than allowed";
    case ZoneCause::kContactTooLate:
      return "a contact is later than allowed";
    case ZoneCause::kNoShare:
      return "a share of the cell is not heard";
  }
  return "";
}

[[nodiscard]] inline PlacedBy placed_by(const Scene& scene, std::uint32_t object) {
  if (scene.objects[object].is_seen()) return PlacedBy::kFrames;
  const bool is_link = std::ranges::any_of(scene.robots, [=](const Robot& robot) {
    return std::ranges::find(robot.links, object, &RobotLink::object) != robot.links.end();
  });
  return is_link ? PlacedBy::kJointStates : PlacedBy::kPoses;
}

// Returns the object whose poses place this one: itself, unless it is attached to another object
// without joints in between.
[[nodiscard]] inline std::uint32_t carrying_object(const Scene& scene, std::uint32_t object) {
  const auto robot = std::ranges::find_if(scene.robots, [=](const Robot& each) {
    return each.is_attached && each.links.front().object == object;
  });
  if (robot == scene.robots.end()) return object;
  const Robot& carrier = carrier_of(scene.robots, *robot);
  return carrier.is_attached && carrier.base.kind == RobotBase::Kind::kObject ? carrier.base.object
                                                                              : object;
}

// The same text for a zone of a report of this scene.
[[nodiscard]] inline std::string cause_text(const Scene& scene, const ZoneReport& zone) {
  const std::uint32_t object = carrying_object(scene, zone.cause_object);
  return cause_text(zone.cause, scene.objects[object].name, placed_by(scene, object));
}

}  // namespace clearance
