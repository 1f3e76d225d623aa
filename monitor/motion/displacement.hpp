// How far can any point of a rigid body have moved between two poses?
//
// A point x of the body's frame moves by (p2 - p1) + (R2 - R1) x, so by at most
// |p2 - p1| + |R2 - R1| |x|, and |R2 - R1| = 2 sin(theta / 2) for the angle theta between the two.
// A path by a third pose, on the straight line and on the shorter turn between the two, is no
// longer than |p2 - p1| + 4 sin(theta / 4) |x| in all: that is the bound here. The two bounds
// differ by less than a hundredth for turns below half a radian. Other paths between the poses do
// not count.
#pragma once

#include "core/pose.hpp"

namespace clearance {

// Rounding of a turn between two orientations, rad. A unit quaternion takes four squares, a root, a
// quotient and a product (where the norm is nearly 1, a term of a series instead of root and
// quotient). So it is within 5/4 * 2^-51 of the exact one, the difference of two within 5/4 *
// 2^-50, and twice that within 5/4 * 2^-49. Their product is not farther off.
inline constexpr double kTurnRounding = 0x1p-48;
// Squares of differences below 1e-154 underflow; the norm is then below this, m.
inline constexpr double kShiftUnderflow = 1e-150;
// A velocity is a sum of products, each within a few 2^-52 of its factors' size.
inline constexpr double kVelocityError = 0x1p-46;

// Both figures are upper bounds, rounding included, for the exactly normalised orientations.
struct Motion {
  double shift = 0.0;  // |p2 - p1|, m
  double turn = 0.0;   // |R - R1| + |R2 - R| for any R on the shorter turn, at most 2 sqrt(2)
};

// Equal poses, bit for bit, give exactly no motion. Norms of the orientations within 0.5 .. 2.
[[nodiscard]] Motion motion_between(const Pose& before, const Pose& after) noexcept;

// No point within `radius` of the frame's origin has moved farther, m; nor is its path by any pose
// between the two longer. An infinite radius is allowed.
[[nodiscard]] double moved_at_most(const Motion& motion, double radius) noexcept;

// The origin moves straight at constant velocity, and the body turns at a constant rate about one
// axis, by the smaller angle. Then no point within `radius` of the origin is ever farther than
// this, m, from where it would be if it, too, moved straight at constant velocity between its two
// places.
//
// A point of a body that turns by theta in a unit of time is accelerated by theta^2 |x|, and a
// function of time is off its chord by at most an eighth of its largest second derivative. `turn`
// is 4 sin(theta / 4), at least 0.9 theta for half a turn or less.
[[nodiscard]] double bend_at_most(const Motion& motion, double radius) noexcept;

}  // namespace clearance
