#include "tools/ask/bag_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "monitor/recording/bag.hpp"
#include "monitor/wire/cdr.hpp"
#include "monitor/wire/ros_types.hpp"

namespace clearance {
namespace {

constexpr std::string_view kTrajectory = "trajectory_msgs/msg/JointTrajectory";
constexpr std::string_view kClock = "/clock";
// 2^62 ns, a time in the year 2116.
constexpr std::int64_t kLastTimeNs = std::int64_t{1} << 62;

}  // namespace

std::string read_motions(const std::filesystem::path& bag, std::vector<BagMotion>& motions) {
  const std::unique_ptr<Bag> file = open_bag(bag);
  std::optional<std::int64_t> first_ns;
  BagMessage message;
  CdrDecoder decoder;
  Sample<rosgraph_msgs_msg_dds__Clock_> clock;
  std::int64_t clock_ns = 0;
  while (file->next(message)) {
    const std::int64_t log_ns = std::clamp(message.log_ns, std::int64_t{0}, kLastTimeNs);
    if (!first_ns) first_ns = log_ns;
    if (message.topic->name == kClock && decoder.decode(message.payload, clock))
      clock_ns = std::int64_t{clock->clock.sec} * 1'000'000'000 + clock->clock.nanosec;
    if (message.topic->type != kTrajectory) continue;
    motions.push_back({fmt::format("{} at {:.3f} s", message.topic->name,
                                   1e-9 * static_cast<double>(log_ns - *first_ns)),
                       message.topic->name,
                       {message.payload.begin(), message.payload.end()},
                       log_ns,
                       clock_ns});
  }
  std::ranges::stable_sort(motions, {}, &BagMotion::log_ns);
  return file->error();
}

}  // namespace clearance
