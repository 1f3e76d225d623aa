// Pairs in which all but one direction is lost in rounding: lines that cross at next to no angle,
// and bodies without end that open by next to none or by next to half a turn.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Segments or capsules whose axes cross at 1e-16 to 1e-2 rad, or miss each other by as little.
[[nodiscard]] HardCase crossing_axes(Random& random);
// A body and its mirror image, as a rule edge to edge, turned against each other by 1e-12 to 1e-3
// rad.
[[nodiscard]] HardCase twisted_images(Random& random);
// A wedge or cone without end, 1e-5 to 1e-2 rad wide, and a bounded body.
[[nodiscard]] HardCase slender_wedges(Random& random);
// All but a half-space: a wedge whose two sides are 1e-6 to 1e-2 rad from level, and a bounded body
// above or in it.
[[nodiscard]] HardCase broad_wedges(Random& random);
// The same of cones of three to eight sides, 1e-5 to 1e-2 rad from level.
[[nodiscard]] HardCase broad_cones(Random& random);

}  // namespace clearance::hard
