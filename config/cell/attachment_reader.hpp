// Attaches objects to links and to other objects: `attached: {to, pose, touch}` of an object.
#pragma once

#include "config/cell/object_reader.hpp"
#include "config/cell/robot_reader.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// Appends the stated attachments to the objects of `list`, behind all others, in the order of the
// file, but carriers before what they carry. What moves with a carrier becomes a robot of one link
// without a joint (Robot::is_attached). What nothing moves becomes a fixed object.
//
// An attached object is also in the groups of its carrier, and absent if its carrier is. Pairs
// within a rigid assembly, and with what it may `touch`, are added to `left_out`. So are pairs of
// what stands on one body, as a cart and the first link of its robot.
void attach_objects(const Quantities& quantities, RobotList& robots, ObjectList& list);

}  // namespace clearance
