// Cells for the adversary.
#pragma once

#include "config/scene/scene.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// Long thin bodies among fixed ones. One of them has two parts and lies off its own origin.
[[nodiscard]] Scene thin_bodies(Random& random);

// Capsules and spheres, most of them moving, half of those with a stated speed, and two zones.
[[nodiscard]] Scene capsules(Random& random);

// Needles, plates, hulls, a small ball, a body of two parts, a floor and two zones.
[[nodiscard]] Scene polyhedra(Random& random);

}  // namespace clearance::test
