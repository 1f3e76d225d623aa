// Bounds of the displacement of any point of a rigid body between two poses.
//
// A point x of the body's frame moves by (p2 - p1) + (R2 - R1) x. For the angle theta between the
// orientations, |R2 - R1| = 2 sin(theta / 2). The displacement is therefore at most
//
//   |p2 - p1| + 2 sin(theta / 2) |x|.
//
// The bound here also covers paths by a third pose on the straight line and on the shorter rotation
// between the two. Such a path is no longer than
//
//   |p2 - p1| + 4 sin(theta / 4) |x|.
//
// The two bounds differ by less than 1 % for rotations below 0.5 rad. Other paths between the poses
// are not covered.
#pragma once

#include "core/pose.hpp"

namespace clearance {

// Rounding error of the rotation between two orientations, rad. To normalise a quaternion takes
// four squares, a root, a quotient and a product. (If the norm is nearly 1, a term of a series
// replaces root and quotient.) The result is within 5/4 * 2^-51 of the exact unit quaternion. The
// difference of two is then within 5/4 * 2^-50, and twice the difference within 5/4 * 2^-49. The
// error of their product is not larger.
inline constexpr double kTurnRounding = 0x1p-48;
// Squares of differences below 1e-154 underflow. The norm of such a difference is below this, m.
inline constexpr double kShiftUnderflow = 1e-150;
// A velocity is a sum of products. The error of each is a few 2^-52 of the size of its factors.
inline constexpr double kVelocityError = 0x1p-46;

// Both numbers are upper bounds, rounding included, for the exactly normalised orientations.
struct Motion {
  double shift = 0.0;  // |p2 - p1|, m
  double turn = 0.0;   // |R - R1| + |R2 - R| for any R on the shorter rotation, at most 2 sqrt(2)
};

// Equal poses, bit for bit, give exactly zero. Norms of the orientations must be within 0.5 .. 2.
[[nodiscard]] Motion motion_between(const Pose& before, const Pose& after) noexcept;

// Bounds the displacement of all points within `radius` of the frame's origin, m. It also bounds
// the length of their paths by any pose between the two. An infinite radius is allowed.
[[nodiscard]] double moved_at_most(const Motion& motion, double radius) noexcept;

// Bounds the deviation of points from straight motion at constant velocity, m. The body's origin
// moves in that manner, and the body rotates at a constant rate about one axis, by the smaller
// angle. The bound holds at every instant for all points within `radius` of the origin. It refers
// to the straight motion of each point between its own two places.
//
// A point of a body that rotates by theta in a unit of time has the acceleration theta^2 |x|. A
// function of time deviates from its chord by at most an eighth of its largest second derivative.
// `turn` is 4 sin(theta / 4), which is at least 0.9 theta for half a rotation or less.
[[nodiscard]] double bend_at_most(const Motion& motion, double radius) noexcept;

}  // namespace clearance
