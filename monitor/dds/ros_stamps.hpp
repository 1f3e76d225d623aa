// When the messages of a publisher of ROS 2 held: as they say, or when they were sent.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "config/scene/ros_stamps.hpp"

namespace clearance {

// One a publisher.
class RosStampCheck {
 public:
  // A machine whose clock is off by more than this has another clock; messages in a row that show
  // it.
  static constexpr std::int64_t kOtherClockNs = 1'000'000'000;
  static constexpr int kOtherClockMessages = 8;

  // The time to use, ns; a stamp of 0 is none. Tells the log, once, that a publisher has a clock of
  // its own: `whose` says whose messages, and the key that would help.
  struct Whose {
    std::string messages, key;
  };
  [[nodiscard]] std::int64_t time_of(std::int64_t stamp_ns, std::int64_t sent_ns, RosStamps wanted,
                                     const std::function<Whose()>& whose);

 private:
  int other_clock_ = 0;  // messages in a row by another clock; negative: it is said
};

// When a sample was sent, by the clock of who sent it.
[[nodiscard]] std::int64_t sent_ns(std::int64_t source_timestamp) noexcept;

}  // namespace clearance
