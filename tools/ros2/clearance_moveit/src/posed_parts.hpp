// The convex parts of links, attached bodies and objects of the world, at their places.
#pragma once

#include "shape_parts.hpp"

#include <memory>
#include <string>
#include <vector>

#include <moveit/collision_detection/collision_common.hpp>
#include <moveit/robot_state/attached_body.hpp>

namespace clearance_moveit {

// A link, an attached body or an object of the world. Parts of one owner are never checked against
// each other.
struct Owner {
  std::string name;
  collision_detection::BodyType type = collision_detection::BodyTypes::WORLD_OBJECT;
  const moveit::core::LinkModel* link = nullptr;  // itself, or what it is attached to; null: world
  const moveit::core::AttachedBody* attached = nullptr;  // null: none

  // Each copy of a state has an attached body of its own, which may be gone by now.
  bool operator==(const Owner& other) const {
    return name == other.name && type == other.type && link == other.link;
  }
};

struct PosedParts {
  std::vector<Owner> owners;
  std::vector<PosedPart> parts;
  std::vector<Box> boxes;  // one around each part, in the world; rounding included

  // Adds the parts of a shape of the last owner.
  void add(const std::shared_ptr<const ShapeParts>& shape, const Eigen::Isometry3d& place);
  // Removes the parts of an owner. The owners behind it keep their order.
  void remove(const std::string& owner);
};

[[nodiscard]] Pose pose_of(const Eigen::Isometry3d& place);

}  // namespace clearance_moveit
