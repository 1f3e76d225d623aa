// Pairs in which rounding loses all directions but one. Their lines cross at a very small angle, or
// their unbounded bodies have an opening angle close to zero or to half a turn.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Segments or capsules whose axes cross at 1e-16 to 1e-2 rad, or miss each other by as little.
[[nodiscard]] HardCase crossing_axes(Random& random);
// A body and its mirror image, usually edge to edge, rotated relative to each other by 1e-12 to
// 1e-3 rad.
[[nodiscard]] HardCase twisted_images(Random& random);
// An unbounded wedge or cone, 1e-5 to 1e-2 rad wide, and a bounded body.
[[nodiscard]] HardCase slender_wedges(Random& random);
// Almost a half-space: a wedge whose two sides are 1e-6 to 1e-2 rad from level. A bounded body
// stands above it or in it.
[[nodiscard]] HardCase broad_wedges(Random& random);
// The same with cones of three to eight sides, 1e-5 to 1e-2 rad from level.
[[nodiscard]] HardCase broad_cones(Random& random);

}  // namespace clearance::hard
