#include "monitor/dds/slow_input_log.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace clearance {

SlowInputLog::SlowInputLog(const Scene& scene)
    : scene_(scene), poses_(SlowInputs::poses(scene)), joints_(SlowInputs::joints(scene)) {}

void SlowInputLog::note(const PoseBatch& batch) {
  note_poses(batch);
  note_joints(batch);
}

void SlowInputLog::note_poses(const PoseBatch& batch) {
  for (const PoseSample& sample : batch.samples) {
    const auto interval_ns = poses_.note(sample.object, sample.stamp_ns);
    if (!interval_ns) continue;
    const Object& object = scene_.objects[sample.object];
    spdlog::warn(
        "poses of {} come every {} ms, its age limit is {} ms: it is late again and again, and its "
        "zones flicker; age_limit_ms of {} would fit",
        object.name, *interval_ns / 1'000'000, object.age_limit_ns / 1'000'000,
        fitting_age_limit_ms(*interval_ns));
  }
}

// One line for all joints of a batch that are found at once.
void SlowInputLog::note_joints(const PoseBatch& batch) {
  std::size_t found = 0;
  std::int64_t interval_ns = 0;
  const JointVariable* first = nullptr;
  for (const JointSample& sample : batch.joints) {
    const auto interval = joints_.note(sample.variable, sample.stamp_ns);
    if (!interval) continue;
    if (found++ == 0) first = &scene_.variables[sample.variable];
    interval_ns = std::max(interval_ns, *interval);
  }
  if (found == 0) return;
  spdlog::warn(
      "joint states from '{}' come at {:.1f} Hz, every {} ms: the age limit of {}{} is {} ms: they "
      "are late again and again, and zones flicker; age_limit_ms of {} would fit",
      batch.source.view(), 1e9 / static_cast<double>(interval_ns), interval_ns / 1'000'000,
      first->name, found > 1 ? fmt::format(" and {} more joints", found - 1) : "",
      first->age_limit_ns / 1'000'000, fitting_age_limit_ms(interval_ns));
}

}  // namespace clearance
