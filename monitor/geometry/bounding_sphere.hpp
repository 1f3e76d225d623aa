// The coarsest model of an object: one sphere around all its parts.
#pragma once

#include <vector>

#include "monitor/geometry/posed_part.hpp"

namespace clearance {

struct BoundingSphere {
  Sphere in_object;  // holds every part; infinite where one is unbounded
  // No point of the object, nor the sphere's centre, is farther from the object's origin, m: what
  // moves the object moves the sphere no farther.
  double reach = 0.0;
};

// One an object. An object without parts has an empty sphere.
[[nodiscard]] std::vector<BoundingSphere> bounding_spheres(std::size_t objects,
                                                           const std::vector<PosedPart>& parts);

// In the world, rounding included.
[[nodiscard]] Sphere placed(const BoundingSphere& sphere, const Pose& world_from_object) noexcept;

// Whatever is in two spheres is at least, and at most, this far apart, m.
[[nodiscard]] double least_between(const Sphere& a, const Sphere& b) noexcept;
[[nodiscard]] double most_between(const Sphere& a, const Sphere& b) noexcept;

}  // namespace clearance
