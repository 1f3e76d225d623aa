// When the messages of a publisher of ROS 2 held: as they say, or when they were sent.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "config/scene/ros_stamps.hpp"
#include "monitor/intake/decoder.hpp"

namespace clearance {

// What becomes of a stamp of another clock than that of the time of sending.
enum class OtherClock : std::uint8_t {
  kTold,      // it is used, and told once: the person who runs the cell can change that
  kReplaced,  // out of a log: the time of recording is used, and it is counted
};

// One a publisher.
class StampCheck {
 public:
  // A machine whose clock is off by more than this has another clock; messages in a row that show
  // it. Recorders may be late: out of a log, it is off by more than the second figure.
  static constexpr std::int64_t kOtherClockNs = 1'000'000'000;
  static constexpr std::int64_t kOtherClockOfLogNs = 10'000'000'000;
  static constexpr int kOtherClockMessages = 8;

  // What to tell: whose messages, and the key of the cell that would help.
  struct Whose {
    std::string messages, key;
  };

  // The time to use, ns; a stamp of 0 is none.
  [[nodiscard]] std::int64_t time_of(std::int64_t stamp_ns, std::int64_t sent_ns, RosStamps wanted,
                                     OtherClock other, TopicCounts& counts, Outlet& out,
                                     const std::function<Whose()>& whose);

 private:
  int other_clock_ = 0;  // messages in a row by another clock; negative: it is told
};

}  // namespace clearance
