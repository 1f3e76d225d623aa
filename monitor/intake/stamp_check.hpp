// The time at which a ROS 2 publisher's message held: its stamp, or its time of sending.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "config/scene/ros_stamps.hpp"
#include "monitor/intake/decoder.hpp"

namespace clearance {

// The treatment of a stamp that is not from the clock of the time of sending.
enum class OtherClock : std::uint8_t {
  kTold,      // it is used and reported once: a person can change the cell
  kReplaced,  // in a log: counted, and replaced by the time of recording
};

// One object for each publisher.
class StampCheck {
 public:
  // The time that counts, ns, whoever asks. A stamp of 0 counts as absent.
  [[nodiscard]] static std::int64_t time_of(std::int64_t stamp_ns, std::int64_t sent_ns,
                                            RosStamps wanted, OtherClock other) noexcept;

  // The difference that shows another clock, ns: that of a live message, then that of a message in
  // a log, since recorders may be late. The last figure is the number of consecutive messages that
  // must show it.
  static constexpr std::int64_t kOtherClockNs = 1'000'000'000;
  static constexpr std::int64_t kOtherClockOfLogNs = 10'000'000'000;
  static constexpr int kOtherClockMessages = 8;

  // For the news: the messages, and the key of the cell that would help.
  struct Whose {
    std::string messages, key;
  };

  // The same; counts and reports what is wrong with the stamp.
  [[nodiscard]] std::int64_t time_of(std::int64_t stamp_ns, std::int64_t sent_ns, RosStamps wanted,
                                     OtherClock other, TopicCounts& counts, Outlet& out,
                                     const std::function<Whose()>& whose);

 private:
  int other_clock_ = 0;  // consecutive messages with another clock; negative: reported
};

}  // namespace clearance
