// How an object is taken to have gone from the last tick's pose to this tick's: its origin straight
// and evenly, its orientation evenly about one axis, the shorter way. monitor/swept/README.md says
// what that covers.
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

// `s` of the way, 0 to 1; at the ends exactly, in between within kInterpolationError of the exact
// place, relative to the lengths that take part, and of the exact orientation.
[[nodiscard]] Pose pose_at(const InterpolatedMotion& motion, double s) noexcept;

// Logarithm, sine, cosine and a product of quaternions, a sum of positions: each within a few 2^-52
// of what it is exactly.
inline constexpr double kInterpolationError = 0x1p-47;

// How one body goes as seen from the frame of the other's object, per whole way. All upper bounds,
// rounding included.
struct RelativeMotion {
  double speed = kInfinity;    // of any point of the body, m
  double turning = kInfinity;  // of any point about the middle of the body's sphere, m
  double bending = kInfinity;  // acceleration of that middle, m
};

// Of a body in a sphere, m, which goes along `moving` and has its middle there at the beginning.
[[nodiscard]] RelativeMotion seen_from(const InterpolatedMotion& resting,
                                       const InterpolatedMotion& moving, const Vec3& middle,
                                       double radius) noexcept;

}  // namespace clearance
