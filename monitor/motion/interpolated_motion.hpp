// The motion that is assumed between the last tick's pose of an object and this tick's: its origin
// moves straight at constant velocity, its orientation turns at a constant rate about one axis, by
// the smaller angle. monitor/swept/README.md says what that covers.
#pragma once

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance {

struct InterpolatedMotion {
  Pose from, to;
  Vec3 shift = Vec3::Zero();  // of the origin, m
  Vec3 turn = Vec3::Zero();   // along the axis, in the world, rad; no longer than pi
  bool turns = false;         // else the two orientations are the same to the bit
};

[[nodiscard]] InterpolatedMotion interpolated_motion(const Pose& from, const Pose& to) noexcept;

// The pose after the share `s` of the motion, 0 to 1. It is exact at the ends. In between it is
// within kInterpolationError of the exact position, relative to the lengths that take part, and of
// the exact orientation.
[[nodiscard]] Pose pose_at(const InterpolatedMotion& motion, double s) noexcept;

// A logarithm, a sine, a cosine, a product of quaternions and a sum of positions are each within a
// few 2^-52 of the exact result.
inline constexpr double kInterpolationError = 0x1p-47;

// The motion of one body as seen from the frame of the other's object, with the whole motion as the
// unit of time. All figures are upper bounds, rounding included.
struct RelativeMotion {
  double speed = kInfinity;    // of any point of the body, m
  double turning = kInfinity;  // speed of any point about the centre of the body's sphere, m
  double bending = kInfinity;  // acceleration of that centre, m
};

// For a body that moves by `moving`, in a sphere of this radius, m, whose centre is at `centre` in
// the world at the beginning.
[[nodiscard]] RelativeMotion seen_from(const InterpolatedMotion& resting,
                                       const InterpolatedMotion& moving, const Vec3& centre,
                                       double radius) noexcept;

}  // namespace clearance
