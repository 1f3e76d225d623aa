// How far can two objects have come as seen from each other? What rides on the same link hardly
// comes nearer, however fast the link is.
#pragma once

#include "monitor/objects/tracked_object.hpp"

namespace clearance {

// No point of either has come farther since the last tick as seen from the other, m, on the way
// there and on the way on from there, both together; infinity: no better than what both have
// displacement. Both were known at the last tick and neither has discontinuous. README.md, "Between
// two ticks".
[[nodiscard]] double relative_displacement(const TrackedObject& a, const TrackedObject& b) noexcept;

}  // namespace clearance
