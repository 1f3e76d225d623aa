// How far can any point of a rigid body have moved between two poses?
//
// A point x of the body's frame moves by (p2 - p1) + (R2 - R1) x, so by at most
// |p2 - p1| + |R2 - R1| |x|, and |R2 - R1| = 2 sin(theta / 2) for the angle theta between the two.
// By way of a third pose, on the straight line and on the shorter turn between them, it moves by no
// more than |p2 - p1| + 4 sin(theta / 4) |x| in all: that is what is told here. The two differ by
// less than a hundredth for turns below half a radian. Other ways between the poses do not count.
#pragma once

#include "core/pose.hpp"

namespace clearance {

// Of a turn between two orientations, rad. Four squares, a root, a quotient and a product, or where
// the norm is nearly 1 a term of a series in place of root and quotient, leave each of the two unit
// quaternions within 5/4 * 2^-51 of the exact one; their difference within 5/4 * 2^-50, and twice
// that within 5/4 * 2^-49; nor is their product farther off.
inline constexpr double kTurnRounding = 0x1p-48;
// Squares of differences below 1e-154 underflow; their norm is then below this, m.
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

// No point within `reach` of the frame's origin has moved farther, m, nor to any pose on the
// straight way and on from there, both together. An infinite reach is allowed.
[[nodiscard]] double moved_at_most(const Motion& motion, double reach) noexcept;

// No point within `reach` of the frame's origin is ever farther than this from where it would be if
// it went straight and evenly from its place before to its place after, m, while the origin goes so
// and the body turns evenly about one axis, the shorter way.
//
// What turns by theta a unit of time is accelerated by theta^2 |x|, and a function of time is off
// its chord by no more than an eighth of its largest second derivative. `turn` is 4 sin(theta / 4),
// at least 0.9 theta for half a turn or less.
[[nodiscard]] double bend_at_most(const Motion& motion, double reach) noexcept;

}  // namespace clearance
