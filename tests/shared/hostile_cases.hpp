// Pairs made with the intention to break a distance algorithm: many difficulties at once, and
// numbers at the limits of doubles.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Needles and plates with an aspect ratio of 1e6. Each facet is given three times, with normals
// that differ by 1e-12 to 1e-6, and the body lies up to 1e7 from its frame's origin.
[[nodiscard]] HardCase crumpled(Random& random);
// Boxes, prisms and plates given by vertices that are rounded after a rotation. Their
// quadrilaterals are planar up to one ulp, and the bodies stand face to face.
[[nodiscard]] HardCase ulp_quads(Random& random);
// Bodies of 1e-10 to 1e-6 m or 1e6 to 1e11 m, beside each other and beside a box of one metre.
[[nodiscard]] HardCase dust(Random& random);
// Bodies of one metre that stand 1e9 to 1e12 m from the world's origin, with zeros of either sign.
[[nodiscard]] HardCase far_poses(Random& random);
// The same body twice in one pose, or in poses that differ by a sign, a factor or an ulp.
[[nodiscard]] HardCase selfsame(Random& random);
// Blades whose edges cross at 1e-16 to 1e-3 rad, far from their frames' origins.
[[nodiscard]] HardCase razors(Random& random);

}  // namespace clearance::hard
