#include "tools/ask/bag_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "monitor/recording/bag.hpp"

namespace clearance {
namespace {

constexpr std::string_view kTrajectory = "trajectory_msgs/msg/JointTrajectory";
// 2^62 ns, a time in the year 2116.
constexpr std::int64_t kLastTimeNs = std::int64_t{1} << 62;

}  // namespace

std::string read_motions(const std::filesystem::path& bag, std::vector<BagMotion>& motions) {
  const std::unique_ptr<Bag> file = open_bag(bag);
  std::optional<std::int64_t> first_ns;
  BagMessage message;
  while (file->next(message)) {
    const std::int64_t log_ns = std::clamp(message.log_ns, std::int64_t{0}, kLastTimeNs);
    if (!first_ns) first_ns = log_ns;
    if (message.topic->type != kTrajectory) continue;
    motions.push_back({fmt::format("{} at {:.3f} s", message.topic->name,
                                   1e-9 * static_cast<double>(log_ns - *first_ns)),
                       {message.payload.begin(), message.payload.end()},
                       log_ns});
  }
  std::ranges::stable_sort(motions, {}, &BagMotion::log_ns);
  return file->error();
}

}  // namespace clearance
