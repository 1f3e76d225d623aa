// The two times that a message of ROS 2 has.
#pragma once

#include <cstdint>

namespace clearance {

// When a message of ROS 2 held: as its header says, or when it was sent, by the clock of the
// machine that sent it.
enum class RosStamps : std::uint8_t { kMessage, kSent };

}  // namespace clearance
