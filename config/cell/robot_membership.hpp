// The groups of a robot's links, and whether they are there: of itself and of what carries it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/cell/object_reader.hpp"
#include "config/scene/robot.hpp"

namespace clearance {

struct Membership {
  std::vector<std::string> groups;  // of its links; its name first
  // An attached robot has the index of its carrier into ObjectList::objects. Nothing: a link
  // without shapes carries it.
  std::optional<std::uint32_t> carrier;
  bool absent = false;
};

// Names a robot, and tells whether the cell says that it is absent.
struct StatedRobot {
  const std::string& name;
  bool absent = false;
};

// Returns the membership of an attached robot. As an attached object, it is in the groups of its
// carrier, too, and is absent with it. `robots` and their `memberships` are those before it.
[[nodiscard]] Membership membership_of(const StatedRobot& robot, const RobotBase& base,
                                       std::span<const Robot> robots,
                                       std::span<const Membership> memberships,
                                       const ObjectList& objects);

}  // namespace clearance
