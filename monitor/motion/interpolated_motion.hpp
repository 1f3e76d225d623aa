// How an object is taken to have gone from the last tick's pose to this tick's: its origin straight
// and evenly, its orientation evenly about one axis, the shorter way. README.md, "Between two
// ticks", says what that covers.
#pragma once

#include "monitor/geometry/posed_part.hpp"

namespace clearance {

struct InterpolatedMotion {
  Pose from, to;
  Vec3 shift = Vec3::Zero();  // of the origin, m
  Vec3 turn = Vec3::Zero();   // along the axis, in the world, rad; no longer than pi
  bool turns = false;         // else the two orientations are the same to the bit
};

// None where nothing was known of the object at the last tick.
[[nodiscard]] InterpolatedMotion way_of(const TrackedObject& object) noexcept;

// `s` of the way, 0 to 1; at the ends exactly.
[[nodiscard]] Pose pose_on_way(const InterpolatedMotion& way, double s) noexcept;

// Puts a part of the object where it is at `s` of the way, 0 to 1. Its errors hold for that.
void place_on_way(const InterpolatedMotion& way, double s, PosedPart& part) noexcept;

// How one part goes as seen from the frame of the other's object, per whole way. All upper bounds,
// rounding included.
struct RelativeMotion {
  double speed = kInfinity;    // of any point of the part, m
  double turning = kInfinity;  // of any point about the middle of the part's sphere, m
  double bending = kInfinity;  // acceleration of that middle, m
};

// `part` goes along `moving` and has been placed at its beginning.
[[nodiscard]] RelativeMotion seen_from(const InterpolatedMotion& resting,
                                       const InterpolatedMotion& moving,
                                       const PosedPart& part) noexcept;

}  // namespace clearance
