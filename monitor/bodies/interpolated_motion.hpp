// The motion that is assumed between an object's pose at the last tick and its pose at this tick.
// The origin moves straight at constant velocity. The orientation rotates at a constant rate about
// one axis, by the smaller angle. monitor/schedule/SWEPT.md says what this covers.
#pragma once

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

struct InterpolatedMotion {
  Pose from, to;
  Vec3 shift = Vec3::Zero();  // of the origin, m
  Vec3 turn = Vec3::Zero();   // rotation vector in the world, rad; no longer than pi
  bool turns = false;         // false: the two orientations are equal, bit for bit
};

[[nodiscard]] InterpolatedMotion interpolated_motion(const Pose& from, const Pose& to) noexcept;

// The pose after the share `s` of the motion, 0 to 1. It is exact at both ends. In between, the
// error of the orientation is at most kInterpolationError. The error of the position is at most
// kInterpolationError times the lengths that are added up.
[[nodiscard]] Pose pose_at(const InterpolatedMotion& motion, double s) noexcept;

// A logarithm, a sine, a cosine, a product of quaternions and a sum of positions each have an error
// of a few 2^-52.
inline constexpr double kInterpolationError = 0x1p-47;

// Motion of one body in the frame of another object. The unit of time is the whole motion. All
// numbers are upper bounds, rounding included.
struct RelativeMotion {
  double speed = kInfinity;    // of any point of the body, m
  double turning = kInfinity;  // speed of any point about the centre of the body's sphere, m
  double bending = kInfinity;  // acceleration of that centre, m
};

// Bounds the motion of a body that moves by `moving` in the frame that moves by `resting`. The body
// lies in a sphere of this radius, m, whose centre in the world is at `centre` at the beginning.
[[nodiscard]] RelativeMotion seen_from(const InterpolatedMotion& resting,
                                       const InterpolatedMotion& moving, const Vec3& centre,
                                       double radius) noexcept;

}  // namespace clearance
