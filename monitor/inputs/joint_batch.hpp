// Joint samples: positions as one source sent them, in the order in which they were taken. Their
// stamps have the same clock as those of poses (monitor/inputs/pose_batch.hpp).
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace clearance {

inline constexpr std::size_t kMaxSources = 16;  // as in idl/clearance.idl
inline constexpr std::uint32_t kNoSource = kMaxSources;

// One variable of a joint: an angle, a length, or an entry of a quaternion.
struct JointSample {
  std::uint32_t variable = 0;  // index into Scene::variables
  std::uint32_t source = 0;    // number of the sender, below kMaxSources
  std::int64_t stamp_ns = 0;   // when the position held, CLOCK_REALTIME of the sender
  double position = 0.0;       // rad or m; may be infinite, NaN or outside the limits until checked
  double velocity = 0.0;       // of `position`, per second
  bool has_velocity = false;
  std::uint32_t namesake = kNoSource;  // number of the sender whose name this one shares, if any
  bool stopping = false;               // its brakes act, and do so until it stands
};

// True if two samples of a joint agree. Drivers send NaN for a velocity that they do not know.
[[nodiscard]] inline bool say_the_same(const JointSample& a, const JointSample& b) noexcept {
  const bool same_velocity =
      a.velocity == b.velocity || (std::isnan(a.velocity) && std::isnan(b.velocity));
  return a.position == b.position && a.has_velocity == b.has_velocity &&
         (!a.has_velocity || same_velocity);
}

// The largest admissible position and velocity of a joint. The sines and cosines of angles up to
// this bound are computed without loss of digits (bodies/sine_cosine.hpp).
inline constexpr double kLargestJoint = 1e6;  // rad, m, rad/s or m/s

}  // namespace clearance
