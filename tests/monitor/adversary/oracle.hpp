// Computes the true distance of two objects, for the judge of a tick.
#pragma once

#include "tests/monitor/tick/fresh_distance.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {

struct Oracle {
  long double (*distance)(const Object& a, const Pose& world_from_a, const Object& b,
                          const Pose& world_from_b);
  double rounding;  // rounding error of the oracle, m, for objects within metres of the origin
};

// The closed form for spheres and capsules in long double. It shares nothing with the core.
inline constexpr Oracle kClosedForm{true_distance, 0.0};

// Cold queries of the core about every pair of parts. They do not depend on broad phase, schedule,
// displacements or swept bounds.
inline constexpr Oracle kBruteForce{
    [](const Object& a, const Pose& world_from_a, const Object& b, const Pose& world_from_b) {
      return static_cast<long double>(fresh_distance(a, world_from_a, b, world_from_b).upper);
    },
    1e-11};

}  // namespace clearance::test
