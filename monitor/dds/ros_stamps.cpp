#include "monitor/dds/ros_stamps.hpp"

#include <dds/dds.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

namespace clearance {

std::int64_t RosStampCheck::time_of(std::int64_t stamp_ns, std::int64_t sent_ns, RosStamps wanted,
                                    const std::function<Whose()>& whose) {
  if (stamp_ns == 0 || wanted == RosStamps::kSent) return sent_ns;
  const bool is_other_clock = std::abs(stamp_ns - sent_ns) > kOtherClockNs;
  if (!is_other_clock && other_clock_ > 0) other_clock_ = 0;
  if (is_other_clock && other_clock_ >= 0 && ++other_clock_ == kOtherClockMessages) {
    other_clock_ = -1;
    const Whose said = whose();
    spdlog::warn(
        "{} are stamped {:+.3f} s off the time at which they are sent: by a clock of their own, as "
        "of a simulation (use_sim_time); {} would take the time at which they are sent",
        said.messages, 1e-9 * static_cast<double>(stamp_ns - sent_ns), said.key);
  }
  return stamp_ns;
}

std::int64_t sent_ns(std::int64_t source_timestamp) noexcept {
  return source_timestamp > 0 ? source_timestamp : dds_time();
}

}  // namespace clearance
