// The two times of a message of ROS 2.
#pragma once

#include <cstdint>

namespace clearance {

// The time that counts: that of the message's header, or that of its sending, by the clock of the
// machine that sent it.
enum class RosStamps : std::uint8_t { kMessage, kSent };

}  // namespace clearance
