#include "monitor/dds/slow_poses.hpp"

#include <algorithm>

namespace clearance {

SlowPoses::SlowPoses(const Scene& scene) : rates_(scene.objects.size()) {
  for (std::size_t object = 0; object < rates_.size(); ++object) {
    if (!scene.objects[object].fixed) rates_[object].limit_ns = scene.objects[object].age_limit_ns;
  }
}

std::optional<std::int64_t> SlowPoses::note(std::uint32_t object, std::int64_t stamp_ns) {
  if (object >= rates_.size() || rates_[object].limit_ns == 0) return std::nullopt;
  Rate& rate = rates_[object];
  if (stamp_ns <= rate.stamp_ns) return std::nullopt;
  const std::int64_t interval = stamp_ns - rate.stamp_ns;
  const bool first = rate.stamp_ns <= 0;
  rate.stamp_ns = stamp_ns;
  if (first) return std::nullopt;
  if (interval <= rate.limit_ns) {
    rate.count = 0;
    return std::nullopt;
  }
  rate.intervals_ns[rate.count++] = interval;
  if (rate.count < kIntervals) return std::nullopt;
  rate.limit_ns = 0;
  const auto middle = rate.intervals_ns.begin() + kIntervals / 2;
  std::nth_element(rate.intervals_ns.begin(), middle, rate.intervals_ns.end());
  return *middle;
}

std::int64_t fitting_age_limit_ms(std::int64_t interval_ns) noexcept {
  constexpr std::int64_t kStepNs = 10'000'000;
  return (2 * interval_ns + kStepNs - 1) / kStepNs * 10;
}

}  // namespace clearance
