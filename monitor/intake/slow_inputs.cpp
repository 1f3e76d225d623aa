#include "monitor/intake/slow_inputs.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace clearance {
namespace {

std::vector<std::int64_t> pose_limits(const Scene& scene) {
  std::vector<std::int64_t> limits;
  for (const Object& object : scene.objects) {
    limits.push_back(object.fixed ? 0 : object.age_limit_ns);
  }
  return limits;
}

std::vector<std::int64_t> joint_limits(const Scene& scene) {
  std::vector<std::int64_t> limits;
  for (const JointVariable& variable : scene.variables) limits.push_back(variable.age_limit_ns);
  return limits;
}

void tell_as_slow(Outlet& out, const std::string& inputs, std::int64_t interval_ns,
                  const std::string& of, std::int64_t age_limit_ns) {
  out.tell(News(lines::kSlowInput, inputs, 1e9 / static_cast<double>(interval_ns),
                interval_ns / 1'000'000, of, age_limit_ns / 1'000'000,
                fitting_age_limit_ms(interval_ns)));
}

}  // namespace

SlowIntervals::SlowIntervals(const std::vector<std::int64_t>& limits_ns)
    : rates_(limits_ns.size()) {
  for (std::size_t i = 0; i < rates_.size(); ++i) rates_[i].limit_ns = limits_ns[i];
}

std::optional<std::int64_t> SlowIntervals::note(std::uint32_t input, std::int64_t stamp_ns) {
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

SlowInputs::SlowInputs(const Scene& scene)
    : scene_(&scene), poses_(pose_limits(scene)), joints_(joint_limits(scene)) {}

void SlowInputs::note(const PoseBatch& batch, Outlet& out) {
  note_poses(batch, out);
  note_joints(batch, out);
}

void SlowInputs::note_poses(const PoseBatch& batch, Outlet& out) {
  for (const PoseSample& sample : batch.samples) {
    const auto interval_ns = poses_.note(sample.object, sample.stamp_ns);
    if (!interval_ns) continue;
    const Object& object = scene_->objects[sample.object];
    tell_as_slow(out, fmt::format("poses of {}", object.name), *interval_ns, object.name,
                 object.age_limit_ns);
  }
}

// Reports all joints that one batch reveals as slow in one sentence.
void SlowInputs::note_joints(const PoseBatch& batch, Outlet& out) {
  std::size_t found = 0;
  std::int64_t interval_ns = 0;
  const JointVariable* first = nullptr;
  for (const JointSample& sample : batch.joints) {
    const auto interval = joints_.note(sample.variable, sample.stamp_ns);
    if (!interval) continue;
    if (found++ == 0) first = &scene_->variables[sample.variable];
    interval_ns = std::max(interval_ns, *interval);
  }
  if (found == 0) return;
  const std::string more = found > 1 ? fmt::format(" and {} more joints", found - 1) : "";
  tell_as_slow(out, fmt::format("joint states from '{}'", batch.source.view()), interval_ns,
               first->name + more, first->age_limit_ns);
}

std::int64_t fitting_age_limit_ms(std::int64_t interval_ns) noexcept {
  constexpr std::int64_t kStepNs = 10'000'000;
  return (2 * interval_ns + kStepNs - 1) / kStepNs * 10;
}

}  // namespace clearance
