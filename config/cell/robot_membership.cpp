#include "config/cell/robot_membership.hpp"

namespace clearance {

Membership membership_of(const StatedRobot& robot, const RobotBase& base,
                         std::span<const Robot> robots, std::span<const Membership> memberships,
                         const ObjectList& objects) {
  Membership of{.groups = {robot.name}, .carrier = {}, .absent = robot.absent};
  std::vector<std::string> groups;
  const RestingOn& rests = base.resting_on;
  if (base.kind == RobotBase::Kind::kLink || rests.kind == RestingOn::Kind::kLink) {
    const Membership& carrier = memberships[base.robot];
    groups = carrier.groups;
    of.absent = of.absent || carrier.absent;
    const std::uint32_t link = robots[base.robot].links[base.link].object;
    if (link != RobotLink::kNoObject) of.carrier = link;
  } else if (base.kind == RobotBase::Kind::kObject || rests.kind == RestingOn::Kind::kObject) {
    of.carrier = base.kind == RobotBase::Kind::kObject ? base.object : rests.object;
    groups = objects.objects[*of.carrier].groups;
    of.absent = of.absent || objects.objects[*of.carrier].absent;
  }
  for (std::string& group : groups)
    if (group != robot.name) of.groups.push_back(std::move(group));
  return of;
}

}  // namespace clearance
