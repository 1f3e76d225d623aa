// The pose of a body, its velocity, and the pose of one body relative to another.
#pragma once

#include <cmath>
#include <cstddef>

#include "core/vec.hpp"

namespace clearance {

// No coordinate, offset or radius of a shape is larger, and no two frames are farther from each
// other, m.
inline constexpr double kLargestCoordinate = 1e12;
// Quaternions are of unit length to this.
inline constexpr double kUnitTolerance = 1e-6;

[[nodiscard]] inline bool is_unit(const Eigen::Quaterniond& q) noexcept {
  return std::abs(q.squaredNorm() - 1.0) <= 2.0 * kUnitTolerance;
}

// A point x of the object's own frame is at position + R(orientation / |orientation|) x in the
// world. The quaternion is of unit length to kUnitTolerance, and every use means its exact
// normalisation. Quaternions are stored x, y, z, w, as in Eigen and on the wire. A pose is one
// cache line. Queries over many pairs read poses at random, and with two lines a pose they would
// take a thirtieth longer.
struct alignas(64) Pose {
  Vec3 position = Vec3::Zero();  // m
  // Eigen aligns it to 8, 16 or 32 bytes, depending on compiler switches. 32 covers them all, so a
  // library and its users agree on the layout.
  alignas(32) Eigen::Quaterniond orientation = Eigen::Quaterniond(1.0, 0.0, 0.0,
                                                                  0.0);  // Eigen's order: w,x,y,z
};
static_assert(sizeof(Pose) == 64 && alignof(Pose) == 64 && offsetof(Pose, orientation) == 32);

// True if both have the same numbers. A quaternion and its negative differ.
[[nodiscard]] inline bool same_pose(const Pose& a, const Pose& b) noexcept {
  return a.position == b.position && a.orientation.coeffs() == b.orientation.coeffs();
}

// Velocity of an object: of the origin of its frame, and its rotation; both along world axes.
struct Twist {
  Vec3 linear = Vec3::Zero();   // m/s
  Vec3 angular = Vec3::Zero();  // rad/s
};
static_assert(sizeof(Twist) == 48 && alignof(Twist) == 8);

// R(q / |q|) without a square root: N(q) / |q|^2. Its entries are within 2^-49.
[[nodiscard]] inline Mat3 rotation_matrix(const Eigen::Quaterniond& q) noexcept {
  const double w = q.w(), x = q.x(), y = q.y(), z = q.z();
  const double s = 2.0 / ((w * w + x * x) + (y * y + z * z));
  Mat3 r;
  r << 1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y),  //
      s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x),   //
      s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y);
  return r;
}

// Pose of an object whose frame is `inner` as placed in `outer`: outer_from_inner.
[[nodiscard]] Pose compose(const Pose& outer, const Pose& inner) noexcept;

// A point of the object's frame, in the world.
[[nodiscard]] Vec3 transform(const Pose& pose, const Vec3& point) noexcept;

// transform() is off by at most this times |position| + |point|. The normalised quaternion is
// within 2^-51, and the nine entries of its matrix are within 2^-49 of the exact ones. The product
// and the sum add three roundings of numbers no larger. The bound covers compose() and its
// orientation as well.
inline constexpr double kPlacingError = 0x1p-47;

// The pose of B in A's frame: x_a = rotation * x_b + translation. It is made once per query. The
// errors of both quantities are part of the value, so that bounds can account for them.
struct RelativePose {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();  // m, in frame A
  double rotation_error = 0.0;      // |R - R_exact| (2-norm) is at most this
  double translation_error = 0.0;   // |t - t_exact| is at most this, m
};
static_assert(sizeof(RelativePose) == 112 && alignof(RelativePose) == 8);

// On an error, the result has NaNs. An error is a quaternion that is not of unit length, a number
// that is not finite, or frames more than kLargestCoordinate from each other. distance() then
// returns kBadPose. Equal orientations (up to the quaternions' sign) give exactly the identity.
// Orientations that permute axes give exactly that permutation. Both have rotation_error 0, so that
// parallel features stay parallel.
[[nodiscard]] RelativePose relative_pose(const Pose& world_from_a,
                                         const Pose& world_from_b) noexcept;

}  // namespace clearance
