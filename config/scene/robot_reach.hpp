// The reach of a cell's robots follows from their chains of joints.
#pragma once

#include <string>
#include <variant>

#include "config/scene/reach_ball.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

// The ball around all links, and what they carry, as long as joints are within their limits. Else a
// reason, as the end of a sentence: no robot, bases that do not move together, or a joint that
// slides without limits.
[[nodiscard]] std::variant<ReachBall, std::string> robots_reach(const Scene& scene);

}  // namespace clearance
