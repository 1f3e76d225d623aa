// Cells for the adversary.
#pragma once

#include "config/scene/scene.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// Long thin bodies, one of them in two pieces and off its own origin, among fixed ones.
[[nodiscard]] Scene thin_bodies(Random& random);

// Capsules and spheres, most of them moving, half of those with a stated speed; two zones.
[[nodiscard]] Scene capsules(Random& random);

// Needles, plates, hulls, a pebble and a body in two pieces, a floor; two zones.
[[nodiscard]] Scene polyhedra(Random& random);

}  // namespace clearance::test
