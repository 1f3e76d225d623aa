#include "monitor/intake/ros_clock.hpp"

#include <algorithm>
#include <utility>

#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

constexpr std::string_view kClock = "/clock", kClockType = "rosgraph_msgs/msg/Clock";
// A silence is noticed with this delay.
constexpr std::int64_t kPatienceNs = 100'000'000;

}  // namespace

std::optional<Decoder::Wanted> RosClock::wants(const TopicName& topic) {
  if (time_ == nullptr || topic.name != kClock || topic.type != kClockType) return std::nullopt;
  return Wanted{0, &kRosClock};
}

std::vector<NamedTopic> RosClock::named() const {
  if (time_ == nullptr) return {};
  return {{std::string(kClock), &kRosClock}};
}

bool RosClock::decode(std::uint32_t, const RawMessage& message, const Now& now, TopicCounts&) {
  if (!decoder_.decode(message.cdr, message_, message.bytes)) return false;
  const auto& [sec, nanosec] = message_->clock;
  if (sec < 0) return false;
  const bool was_silent = time_->is_silent(now.monotonic_ns);
  if (writer_.value_or(message.writer) != message.writer && !was_silent) {
    if (!std::exchange(is_rival_said_, true)) out_.tell(News(lines::kTwoClocks));
    return true;
  }
  writer_ = message.writer;
  const std::int64_t before_ns = time_->clock_ns();
  const std::int64_t time_ns = std::int64_t{sec} * 1'000'000'000 + nanosec;
  switch (time_->note(time_ns, message.sent_ns, now.monotonic_ns)) {
    case SimulatedTime::Change::kBack:
      out_.tell(News(lines::kSimTimeBack, seconds(before_ns), seconds(time_ns)));
      break;
    case SimulatedTime::Change::kFirst:
      out_.tell(News(lines::kSimTimeHeard, seconds(time_ns)));
      break;
    case SimulatedTime::Change::kGoesOn:
      if (was_silent) out_.tell(News(lines::kSimTimeHeard, seconds(time_ns)));
  }
  is_waiting_said_ = false;
  return true;
}

void RosClock::settle(const Now& now) {
  if (time_ == nullptr) return;
  const bool is_silent = time_->is_silent(now.monotonic_ns);
  if ((time_->is_known() && !is_silent) || std::exchange(is_waiting_said_, true)) return;
  if (is_silent) {
    out_.tell(News(lines::kSimTimeSilent, seconds(time_->clock_ns())));
  } else {
    out_.tell(News(lines::kSimTimeAwaited));
  }
}

std::int64_t RosClock::patience_ns() const {
  return time_ == nullptr ? Decoder::patience_ns() : kPatienceNs;
}

void RosClock::keep(std::span<const std::uint64_t> writers) {
  if (!writer_ || std::ranges::binary_search(writers, *writer_)) return;
  writer_.reset();
  is_rival_said_ = false;
}

}  // namespace clearance
