// Do the two bodies share a point beyond doubt?
#pragma once

#include "core/active_side.hpp"
#include "core/precision.hpp"

namespace clearance {

// Starts where the two points met and goes deeper into both bodies (steepest descent on the largest
// facet violation, which is convex) until a point lies inside every facet of both by more than
// rounding. That point, in the common frame, is the proof. False: none found, which proves nothing.
[[nodiscard]] bool share_a_point(const ActiveSide& a, const ActiveSide& b, const Precision& p,
                                 Vec3& shared) noexcept;

}  // namespace clearance
