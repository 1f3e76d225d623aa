// The coarsest model of an object: one ball around all its parts.
#pragma once

#include <vector>

#include "monitor/geometry/posed_part.hpp"

namespace clearance {

struct BoundingSphere {
  Ball in_object;  // holds every part; infinite where one is unbounded
  // No point of the object, nor the ball's centre, is farther from the object's origin, m: what
  // moves the object moves the ball no farther.
  double reach = 0.0;
};

// One an object. An object without parts has an empty ball.
[[nodiscard]] std::vector<BoundingSphere> bounding_spheres(std::size_t objects,
                                                           const std::vector<PosedPart>& parts);

// In the world, rounding included.
[[nodiscard]] Ball placed(const BoundingSphere& ball, const Pose& world_from_object) noexcept;

// Whatever is in two balls is at least, and at most, this far apart, m.
[[nodiscard]] double least_between(const Ball& a, const Ball& b) noexcept;
[[nodiscard]] double most_between(const Ball& a, const Ball& b) noexcept;

}  // namespace clearance
