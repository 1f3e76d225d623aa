// The carrier of a sensor: the world, an object, or a link of a robot, placed by joints.
#pragma once

#include <cstdint>

#include "config/scene/scene.hpp"

namespace clearance {

struct Carrier {
  RobotBase::Kind kind = RobotBase::Kind::kWorld;
  std::uint32_t object = 0;           // index into Scene::objects; not a link
  std::uint32_t robot = 0, link = 0;  // indices into Scene::robots and Robot::links

  bool operator==(const Carrier&) const = default;
};

// True if the scene has the carrier.
[[nodiscard]] inline bool has(const Scene& scene, const Carrier& carrier) noexcept {
  switch (carrier.kind) {
    case RobotBase::Kind::kWorld:
      return true;
    case RobotBase::Kind::kObject:
      return carrier.object < scene.objects.size();
    case RobotBase::Kind::kLink:
      return carrier.robot < scene.robots.size() &&
             carrier.link < scene.robots[carrier.robot].links.size();
  }
  return false;
}

}  // namespace clearance
