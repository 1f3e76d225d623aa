// The reach of a cell's robots follows from their chains of joints.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "config/scene/reach_ball.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

// Returns the radius of the ball around the object's origin that contains all its parts, m.
[[nodiscard]] double radius_of(const Object& object);

// Returns one ball around the base of each robot that stands on no other robot. While joints are
// within their limits, the balls contain all links and what they carry. If there is no robot, or a
// joint slides without limits, returns the reason as the end of a sentence.
[[nodiscard]] std::variant<std::vector<ReachBall>, std::string> robots_reach(const Scene& scene);

}  // namespace clearance
