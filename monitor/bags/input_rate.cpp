#include "monitor/bags/input_rate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace clearance {
namespace {

// Longer ones are pauses, and say nothing of a rate.
constexpr std::int64_t kPauseNs = 2'000'000'000;
// Fewer intervals say nothing either.
constexpr std::uint64_t kFewest = 8;

// An age limit that fits: two intervals, to the next 10 ms.
std::int64_t fitting_ms(std::int64_t interval_ns) {
  constexpr std::int64_t kStepNs = 10'000'000;
  return (2 * interval_ns + kStepNs - 1) / kStepNs * 10;
}

}  // namespace

void InputRate::note(const Scene& scene, const PoseBatch& batch) {
  std::int64_t stamp_ns = stamp_ns_, limit_ns = std::numeric_limits<std::int64_t>::max();
  for (const JointSample& sample : batch.joints) {
    stamp_ns = std::max(stamp_ns, sample.stamp_ns);
    limit_ns = std::min(limit_ns, scene.variables[sample.variable].age_limit_ns);
  }
  for (const PoseSample& sample : batch.samples) {
    stamp_ns = std::max(stamp_ns, sample.stamp_ns);
    limit_ns = std::min(limit_ns, scene.objects[sample.object].age_limit_ns);
  }
  const std::int64_t interval_ns = stamp_ns - stamp_ns_;
  const bool first = stamp_ns_ < 0;
  stamp_ns_ = stamp_ns;
  if (first || interval_ns == 0 || interval_ns > kPauseNs) return;
  limit_ns_ = limit_ns;
  ++intervals_;
  sum_ns_ += interval_ns;
  if (interval_ns > limit_ns) ++too_long_;
}

void InputRate::add_note(const std::string& source, std::vector<std::string>& notes) const {
  if (intervals_ < kFewest || 2 * too_long_ <= intervals_) return;
  const std::int64_t interval_ns = sum_ns_ / static_cast<std::int64_t>(intervals_);
  notes.push_back(fmt::format(
      "{} come every {:.3g} ms, their age limit is {:g} ms: they are late in between; an age limit "
      "of {} ms would fit",
      source, 1e-6 * static_cast<double>(interval_ns), 1e-6 * static_cast<double>(limit_ns_),
      fitting_ms(interval_ns)));
}

}  // namespace clearance
