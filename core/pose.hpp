// Where a body is, how it moves, and where one body is as seen from another.
#pragma once

#include <cmath>
#include <cstddef>

#include "core/vec.hpp"

namespace clearance {

// No coordinate, offset or radius of a shape is larger, and no two frames are farther apart, m.
inline constexpr double kLargestCoordinate = 1e12;
// Quaternions are of unit length to this.
inline constexpr double kUnitTolerance = 1e-6;

[[nodiscard]] inline bool is_unit(const Eigen::Quaterniond& q) noexcept {
  return std::abs(q.squaredNorm() - 1.0) <= 2.0 * kUnitTolerance;
}

// A point x of the object's own frame is at position + R(orientation / |orientation|) x in the
// world. The quaternion is of unit length to kUnitTolerance, and every use means its exact
// normalisation. Quaternions are stored x, y, z, w (as Eigen does, and as on the wire). A cache
// line each: queries over many pairs read poses here and there, and each on two lines takes a
// thirtieth longer.
struct alignas(64) Pose {
  Vec3 position = Vec3::Zero();  // m
  // Eigen's own alignment of it is 8, 16 or 32, by the switches of each compilation; this covers
  // them all, so that it is in one place for a library and whoever uses it.
  alignas(32) Eigen::Quaterniond orientation = Eigen::Quaterniond(1.0, 0.0, 0.0,
                                                                  0.0);  // Eigen's order: w,x,y,z
};
static_assert(sizeof(Pose) == 64 && alignof(Pose) == 64 && offsetof(Pose, orientation) == 32);

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

// transform() is off by at most this times |position| + |point|: normalising the quaternion leaves
// it within 2^-51, the nine entries of its matrix within 2^-49 of the exact matrix, and the product
// and sum add three roundings of numbers no larger. The same covers compose(), and the orientation
// that it gives.
inline constexpr double kPlacingError = 0x1p-47;

// B as seen from A: x_a = rotation * x_b + translation. Made once a query. How far the two
// doubles-only quantities can be from the exact ones is part of the value, so that bounds can
// account for it.
struct RelativePose {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();  // m, in frame A
  double rotation_error = 0.0;      // |R - R_exact| (2-norm) is at most this
  double translation_error = 0.0;   // |t - t_exact| is at most this, m
};
static_assert(sizeof(RelativePose) == 112 && alignof(RelativePose) == 8);

// Error behaviour: none. Of a quaternion that is not of unit length, of frames more than
// kLargestCoordinate apart, and of what is not finite come NaNs, of which distance() says kBadPose.
// Equal orientations (up to the quaternions' sign) give exactly the identity, and orientations that
// permute axes exactly that permutation, each with rotation_error 0: parallel stays parallel.
[[nodiscard]] RelativePose relative_pose(const Pose& world_from_a,
                                         const Pose& world_from_b) noexcept;

}  // namespace clearance
