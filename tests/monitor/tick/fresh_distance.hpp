// Oracle for the tick: a new query for every pair of parts, without tracking, triage or a motion
// bound.
#pragma once

#include <algorithm>

#include "config/scene/scene.hpp"
#include "core/distance.hpp"

namespace clearance::test {

// Bounds of the distance of two objects, as narrow as the queries give them.
struct DistanceBounds {
  double lower = kInfinity, upper = kInfinity;
};

[[nodiscard]] inline DistanceBounds fresh_distance(const Object& a, const Pose& world_from_a,
                                                   const Object& b, const Pose& world_from_b) {
  DistanceBounds truth;
  for (const Part& part_a : a.parts) {
    for (const Part& part_b : b.parts) {
      TrackingState cold;
      const DistanceResult found =
          distance(part_a.shape, part_b.shape,
                   relative_pose(compose(world_from_a, part_a.object_from_part),
                                 compose(world_from_b, part_b.object_from_part)),
                   cold);
      truth.lower = std::min(truth.lower, found.lower);
      truth.upper = std::min(truth.upper, found.upper);
    }
  }
  return truth;
}

}  // namespace clearance::test
