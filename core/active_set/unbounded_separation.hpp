// How far a direction separates two unbounded bodies.
#pragma once

#include "core/active_set/certificate.hpp"

namespace clearance {

// As separation(), of two unbounded bodies, in doubles: only along a direction that no ray of A and
// no reversed ray of B rises along, for certain. A ray certainly does not where it falls by more
// than rounding; along its own body's facet; where the rotation between the bodies has no rounding,
// nor the ray, nor the direction, and their product is exactly 0; and, of two bodies with one line
// each that cross, where it runs along that line. -infinity where doubles cannot tell.
[[nodiscard]] double separation_of_unbounded(const Separator& s, const ActiveFeature& a,
                                             const ActiveFeature& b) noexcept;

}  // namespace clearance
