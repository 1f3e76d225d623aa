// An intake that receives messages, and the batches that it makes of them. No DDS is used: messages
// are bytes, writers are numbers, and the test sets the time.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "monitor/intake/intake.hpp"
#include "tests/monitor/recording/ros_bags.hpp"

namespace clearance::test {

class Heard {
 public:
  // The cell must outlive this object.
  explicit Heard(const Cell& cell, IntakeOptions options = {})
      : intake(cell, std::move(options), [this](PoseBatch& batch) {
          if (!has_room) return false;
          batches.push_back(batch);
          return true;
        }) {}

  // Sends the message at its log_ns from this writer. Returns false if the topic is not wanted or
  // the bytes cannot be decoded.
  bool take(const RosMessage& message, std::uint64_t writer = 1) {
    const auto topic = intake.topic({message.topic, message.type});
    if (!topic) {
      keep_news();
      return false;
    }
    const bool decodes = intake.take(
        {.topic = topic->number, .cdr = message.cdr, .sent_ns = message.log_ns, .writer = writer},
        now);
    keep_news();
    return decodes;
  }
  // Settles the intake, as after a burst of messages.
  void settle() {
    intake.settle(now);
    keep_news();
  }
  void pass(std::int64_t ns) {
    now.realtime_ns += ns;
    now.monotonic_ns += ns;
  }
  // Returns the batches since the last call.
  std::vector<PoseBatch> all() { return std::exchange(batches, {}); }
  // Returns the only batch since the last call.
  PoseBatch one() {
    const std::vector<PoseBatch> came = all();
    EXPECT_EQ(came.size(), 1u);
    return came.empty() ? PoseBatch{} : came.front();
  }
  [[nodiscard]] std::size_t told(std::string_view code) const {
    return static_cast<std::size_t>(std::ranges::count(news, code, &News::code));
  }

  Now now{.realtime_ns = 1'700'000'000'000'000'000, .monotonic_ns = 50'000'000'000};
  bool has_room = true;
  std::vector<PoseBatch> batches;
  std::vector<News> news;
  Intake intake;

 private:
  void keep_news() {
    for (News& each : intake.take_news()) news.push_back(std::move(each));
  }
};

}  // namespace clearance::test
