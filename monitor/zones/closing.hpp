// An upper bound of the speed of a body towards another.
#pragma once

#include "core/vec.hpp"
#include "monitor/bodies/tracked_object.hpp"

namespace clearance {

// An upper bound of the speed of all points of the body along `towards`, a unit vector (NaN: in any
// direction). In m/s, not negative, rounding included. No point is faster than `max_speed`, m/s,
// but the measured speed of its point `witness` counts all the same.
[[nodiscard]] double speed_towards(const TrackedObject& body, const Vec3& towards,
                                   const Vec3& witness, double max_speed) noexcept;

}  // namespace clearance
