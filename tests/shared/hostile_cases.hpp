// Pairs that somebody would make who wants to break a distance algorithm: everything that is hard
// at once, and numbers at the ends of the doubles.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Needles and plates of one by 1e6, each facet thrice, 1e-12 to 1e-6 apart in direction, and the
// whole up to 1e7 from its frame's origin.
[[nodiscard]] HardCase crumpled(Random& random);
// Boxes, prisms and plates given by corners that are rounded after a turn: quads that are plane but
// for one ulp, beside each other face to face.
[[nodiscard]] HardCase ulp_quads(Random& random);
// Of 1e-10 to 1e-6 or 1e6 to 1e11 m, beside each other and beside a box of a metre.
[[nodiscard]] HardCase dust(Random& random);
// Bodies of a metre that stand 1e9 to 1e12 m from the world's origin; zeros of either sign.
[[nodiscard]] HardCase far_poses(Random& random);
// The same body twice in one pose, or in one that differs by a sign, a factor or an ulp.
[[nodiscard]] HardCase selfsame(Random& random);
// Blades whose edges cross at 1e-16 to 1e-3 rad, far from their frames' origins.
[[nodiscard]] HardCase razors(Random& random);

}  // namespace clearance::hard
