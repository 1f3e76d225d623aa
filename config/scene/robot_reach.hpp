// A ball that the links of a cell's robots cannot leave, by their chains of joints.
#pragma once

#include <string>
#include <variant>

#include "config/scene/scene.hpp"

namespace clearance {

struct ReachBall {
  Vec3 centre = Vec3::Zero();  // in the world, m
  double radius = 0.0;         // m
};

// The ball around all links, and what they carry, as long as joints are within their limits. Else a
// reason, as the end of a sentence: no robot, a base that moves, or a joint that slides without
// limits.
[[nodiscard]] std::variant<ReachBall, std::string> robots_reach(const Scene& scene);

}  // namespace clearance
