// How fast a body comes towards another at most.
#pragma once

#include "core/vec.hpp"
#include "monitor/objects/tracked_object.hpp"

namespace clearance {

// Of all points of the body, along `towards`, a unit vector; NaN: in any direction. m/s, not
// negative, rounding included. `max_speed`: what none of its points exceeds, m/s; a measured speed
// of its point `witness` counts all the same.
[[nodiscard]] double speed_towards(const TrackedObject& body, const Vec3& towards,
                                   const Vec3& witness, double max_speed) noexcept;

}  // namespace clearance
