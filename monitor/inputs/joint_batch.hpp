// What joints say of themselves: positions as one source sent them, in the order in which they were
// taken. The stamps are as those of poses (monitor/inputs/pose_batch.hpp).
#pragma once

#include <cstdint>

namespace clearance {

// One variable of a joint: an angle, a length, or an entry of a quaternion.
struct JointSample {
  std::uint32_t variable = 0;  // index into Scene::variables
  std::uint32_t source = 0;    // who sent it: below kMaxSources, the same for all that one sends
  std::int64_t stamp_ns = 0;   // when the position held, CLOCK_REALTIME of who sent it
  double position = 0.0;       // rad or m; neither finite nor within limits until checked
  double velocity = 0.0;       // per second
  bool has_velocity = false;
};

// The largest position and velocity of a joint: angles up to this are turned into sines and cosines
// without losing digits (kinematics/sine_cosine.hpp).
inline constexpr double kLargestJoint = 1e6;  // rad, m, rad/s or m/s

}  // namespace clearance
