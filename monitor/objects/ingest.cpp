#include "monitor/objects/ingest.hpp"

#include <optional>

#include "monitor/source_numbers.hpp"

namespace clearance {
namespace {

// Why not, if the sample is not taken.
std::optional<Reject> take_in_time(const PoseSample& sample, const Scene& scene,
                                   Inputs& inputs) noexcept {
  const Object& object = scene.objects[sample.object];
  TrackedObject& state = inputs.objects[sample.object];
  const std::int64_t stamp_ns = inputs.sources[sample.source].in_tick_time(
      sample.stamp_ns, inputs.time,
      {.future_ns = scene.future_limit_ns, .age_ns = object.age_limit_ns});
  return take(object, sample, stamp_ns, {inputs.time.now_ns, scene.future_limit_ns}, state);
}

std::optional<Reject> take_in_time(const JointSample& sample, const Scene& scene,
                                   Inputs& inputs) noexcept {
  const JointVariable& variable = scene.variables[sample.variable];
  TrackedVariable& state = inputs.robots.variables()[sample.variable];
  const std::int64_t now_ns = inputs.time.now_ns;
  const std::int64_t stamp_ns = inputs.sources[sample.source].in_tick_time(
      sample.stamp_ns, inputs.time,
      {.future_ns = scene.future_limit_ns, .age_ns = variable.age_limit_ns});
  const auto cause = refusal(variable, sample, stamp_ns, {now_ns, scene.future_limit_ns}, state);
  if (cause) return cause;
  accept(variable, sample, stamp_ns, now_ns, state);
  inputs.robots.hear(sample.variable);
  return std::nullopt;
}

void ingest(std::span<const JointSample> joints, const Scene& scene, Inputs& inputs) noexcept {
  for (const JointSample& sample : joints) {
    const bool known = sample.variable < scene.variables.size() && sample.source < kMaxSources;
    const auto cause = known ? take_in_time(sample, scene, inputs) : Reject::kUnknownObject;
    if (!cause) continue;
    ++inputs.rejected[static_cast<std::size_t>(*cause)];
    if (known) {
      ++inputs.robots.variables()[sample.variable].rejected[static_cast<std::size_t>(*cause)];
    }
  }
}

// For a tick that cannot know how much time has passed.
void forget_ages(const TickTime& time, Inputs& inputs) noexcept {
  for (SourceClock& source : inputs.sources) source.forget();
  for (TrackedObject& object : inputs.objects) {
    if (object.seen) forget_age(time.now_ns, object);
  }
  inputs.robots.forget_ages(time.now_ns);
}

}  // namespace

Inputs initial_inputs(const Scene& scene) {
  Inputs inputs{.objects = {}, .robots = RobotInputs(scene), .sources = {}};
  SourceNumbers numbers(scene);
  for (const Object& object : scene.objects) {
    TrackedObject& state = inputs.objects.emplace_back(initial_state(object));
    if (!object.source.empty()) {
      state.owner = InputOwner(numbers.of(SourceName(object.source)));
    }
  }
  for (std::size_t i = 0; i < scene.variables.size(); ++i) {
    const std::string& source = scene.variables[i].source;
    if (source.empty()) continue;
    inputs.robots.variables()[i].owner = InputOwner(numbers.of(SourceName(source)));
  }
  return inputs;
}

void ingest(std::span<const PoseSample> samples, std::span<const JointSample> joints,
            const TickTime& time, const Scene& scene, Inputs& inputs) noexcept {
  ++inputs.cycle;
  if (time.now_ns < inputs.time.now_ns) forget_ages(time, inputs);
  inputs.time = time;
  ingest(joints, scene, inputs);
  for (const PoseSample& sample : samples) {
    if (sample.object >= inputs.objects.size() || scene.objects[sample.object].fixed ||
        sample.source >= kMaxSources || inputs.objects[sample.object].absent) {
      refuse(sample.object, Reject::kUnknownObject, inputs);
    } else if (inputs.robots.follows_joints(sample.object)) {
      refuse(sample.object, Reject::kOtherSource, inputs);
    } else if (const auto cause = take_in_time(sample, scene, inputs)) {
      refuse(sample.object, *cause, inputs);
    }
  }
}

void refuse(std::uint32_t object, Reject cause, Inputs& inputs) noexcept {
  const auto index = static_cast<std::size_t>(cause);
  ++inputs.rejected[index];
  if (object < inputs.objects.size()) ++inputs.objects[object].rejected[index];
}

}  // namespace clearance
