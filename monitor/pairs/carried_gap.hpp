// What a separating direction goes on telling when both parts have moved.
//
// Along a fixed unit direction n from A to B, the gap between two bodies, min over B of n.x less
// max over A of n.x, bounds their distance from below wherever they are (weak duality, §3.2). When
// the bodies are shifted, it changes by exactly n.(shift of B - shift of A); when one turns about
// the middle of its sphere by an angle theta, by no more than 2 sin(theta / 2) times the sphere's
// radius. So the gap of an evaluation and how far the bodies have turned since bound it now: motion
// across n costs nothing, and motion apart gains.
#pragma once

#include "monitor/geometry/posed_part.hpp"

namespace clearance {

// What is kept of an evaluation that told `lower` along `normal` (world, A to B), both for the
// exact poses of now: the gap less that of the spheres' middles, as if neither had ever turned, m.
// -infinity: the direction says nothing later, or there is none.
[[nodiscard]] double kept_gap(double lower, const Vec3& normal, const PosedPart& a,
                              const PosedPart& b) noexcept;

// The distance is at least this now, m.
[[nodiscard]] double lower_along(const Vec3& normal, double kept_gap, const PosedPart& a,
                                 const PosedPart& b) noexcept;

}  // namespace clearance
