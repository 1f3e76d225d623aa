// What finds the true distance of two objects, for the judge of a tick.
#pragma once

#include "tests/monitor/fresh_distance.hpp"
#include "tests/monitor/small_cells.hpp"

namespace clearance::test {

struct Oracle {
  long double (*distance)(const Object& a, const Pose& world_from_a, const Object& b,
                          const Pose& world_from_b);
  double rounding;  // of the oracle itself, m, for objects within metres of the origin
};

// The closed form for spheres and capsules in long double; it shares nothing with the core.
inline constexpr Oracle kClosedForm{true_distance, 0.0};

// The core itself, asked cold about every pair of parts; it knows nothing of broad phase, schedule,
// displacements and swept bounds.
inline constexpr Oracle kBruteForce{
    [](const Object& a, const Pose& world_from_a, const Object& b, const Pose& world_from_b) {
      return static_cast<long double>(fresh_distance(a, world_from_a, b, world_from_b).upper);
    },
    1e-11};

}  // namespace clearance::test
