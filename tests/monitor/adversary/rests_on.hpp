// The bodies in which the faults of a channel show.
#pragma once

#include <cstddef>

#include "tests/monitor/adversary/lies.hpp"
#include "tests/monitor/adversary/true_motion.hpp"

namespace clearance::test::lies {

[[nodiscard]] inline bool is_link_of(Channel robot, std::size_t body) {
  const std::size_t foot = robot == Channel::kPost ? kPostBody : kArmBody;
  return body >= foot && body < foot + kLinks;
}

[[nodiscard]] inline bool rests_on(std::size_t body, Channel channel) {
  if (is_ball(channel)) return body == static_cast<std::size_t>(channel);
  if (channel == Channel::kFollower) return body == kFollowerBody;
  if (channel == Channel::kEye || channel == Channel::kPoints) return body == kEyeBody;
  if (channel == Channel::kPicture) return body == kLensBody;
  if (channel == Channel::kMap) return body == kMapBody;
  if (!is_sent(channel)) return false;
  if (channel == Channel::kBase) return is_link_of(Channel::kArm, body);
  if (channel == Channel::kOdom) return body == kFollowerBody || is_link_of(Channel::kArm, body);
  return is_link_of(channel, body) && body != kArmBody && body != kPostBody;
}

// True if an image of the arm is left out of what this body shows, where the lie says that the arm
// is.
[[nodiscard]] inline bool is_hidden_by(std::size_t body, const Fault& fault) {
  const bool places_arm =
      is_robot(fault.channel) || fault.channel == Channel::kOdom || fault.channel == Channel::kBase;
  const bool is_of_sensor = body == kEyeBody || body == kLensBody || body == kMapBody;
  return fault.lie == Lie::kRivalFirst && places_arm && is_of_sensor;
}

}  // namespace clearance::test::lies
