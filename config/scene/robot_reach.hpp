// The reach of a cell's robots follows from their chains of joints.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "config/scene/reach_ball.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

// The balls that contain all links, and what they carry, as long as joints are within their limits:
// one around the base of each robot that stands on no other one. Else a reason, as the end of a
// sentence: no robot, or a joint that slides without limits.
[[nodiscard]] std::variant<std::vector<ReachBall>, std::string> robots_reach(const Scene& scene);

}  // namespace clearance
