// What comes in: poses as one source sent them, in the order in which they were taken.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/pose.hpp"

namespace clearance {

struct PoseSample {
  std::uint32_t object = 0;   // index into Scene::objects
  std::int64_t stamp_ns = 0;  // when the pose held, CLOCK_REALTIME
  Pose world_from_object;     // as on the wire: neither finite nor of unit length until checked
  Twist twist;
  bool has_twist = false;
};

// Why a sample was not used. Counted per object, named in the health topic.
enum class Reject : std::uint8_t {
  kUnknownObject,  // no such id, or a fixed object
  kNonFinite,      // NaN, infinity or beyond 1e9 (m, m/s, rad/s) in position, orientation or twist
  kNotUnit,        // | |q| - 1 | > 1e-3
  kBackwards,      // stamp before the one in use
  kFuture,         // stamp farther ahead of now than Scene::future_limit_ns
  kWrongRevision,  // made for another scene
};
inline constexpr std::size_t kRejects = 6;
[[nodiscard]] const char* name(Reject cause) noexcept;

}  // namespace clearance
