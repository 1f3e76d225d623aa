// The coarsest model of an object: one sphere around all its parts.
#pragma once

#include <vector>

#include "monitor/bodies/posed_part.hpp"

namespace clearance {

struct BoundingSphere {
  Sphere in_object;  // holds every part; infinite where one is unbounded
  // No point of the object, nor the sphere's centre, is farther from the object's origin, m. So the
  // displacement of the object bounds that of the sphere.
  double bounding_radius = 0.0;
};

// One sphere an object. An object without parts has an empty one.
[[nodiscard]] std::vector<BoundingSphere> bounding_spheres(std::size_t objects,
                                                           const std::vector<PosedPart>& parts);

// In the world, rounding included.
[[nodiscard]] Sphere placed(const BoundingSphere& sphere, const Pose& world_from_object) noexcept;

// The distance of two bodies in two spheres is at least, and at most, this, m.
[[nodiscard]] double least_between(const Sphere& a, const Sphere& b) noexcept;
[[nodiscard]] double most_between(const Sphere& a, const Sphere& b) noexcept;

}  // namespace clearance
