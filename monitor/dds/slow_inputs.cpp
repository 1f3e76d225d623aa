#include "monitor/dds/slow_inputs.hpp"

#include <algorithm>

namespace clearance {

SlowInputs::SlowInputs(const std::vector<std::int64_t>& limits_ns) : rates_(limits_ns.size()) {
  for (std::size_t i = 0; i < rates_.size(); ++i) rates_[i].limit_ns = limits_ns[i];
}

SlowInputs SlowInputs::poses(const Scene& scene) {
  std::vector<std::int64_t> limits;
  for (const Object& object : scene.objects) {
    limits.push_back(object.fixed ? 0 : object.age_limit_ns);
  }
  return SlowInputs(limits);
}

SlowInputs SlowInputs::joints(const Scene& scene) {
  std::vector<std::int64_t> limits;
  for (const JointVariable& variable : scene.variables) limits.push_back(variable.age_limit_ns);
  return SlowInputs(limits);
}

std::optional<std::int64_t> SlowInputs::note(std::uint32_t input, std::int64_t stamp_ns) {
  if (input >= rates_.size() || rates_[input].limit_ns == 0) return std::nullopt;
  Rate& rate = rates_[input];
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
