// Lower bound of a distance by a separating direction, after both parts have moved.
//
// Let n be a fixed unit direction from A to B. The gap of two bodies along n is min over B of n.x
// less max over A of n.x. It bounds their distance from below wherever they are (weak duality,
// §3.2). If the bodies translate, it changes by exactly n.(shift of B - shift of A). If one rotates
// by an angle theta about the centre of its sphere, the gap changes by at most 2 sin(theta / 2)
// times the sphere's radius. So the gap of an evaluation, and the turning since then, bound the gap
// of now. Motion across n costs nothing, and motion that separates the bodies along n gains.
#pragma once

#include "monitor/bodies/posed_part.hpp"

namespace clearance {

// The value to keep from an evaluation that proved `lower` along `normal` (world, A to B) for the
// exact poses of now. It is the gap less that of the spheres' centres, plus all rotation so far, m.
// -infinity: there is no direction, or none that will prove anything later.
[[nodiscard]] double kept_gap(double lower, const Vec3& normal, const PosedPart& a,
                              const PosedPart& b) noexcept;

// A lower bound of the distance now, m.
[[nodiscard]] double lower_along(const Vec3& normal, double kept_gap, const PosedPart& a,
                                 const PosedPart& b) noexcept;

}  // namespace clearance
