#include "monitor/objects/ingest.hpp"

#include <optional>

#include "monitor/source_numbers.hpp"

namespace clearance {
namespace {

// Why not, if the sample is not taken.
std::optional<Reject> take(const PoseSample& sample, const Scene& scene, Inputs& inputs) noexcept {
  const Object& object = scene.objects[sample.object];
  TrackedObject& state = inputs.objects[sample.object];
  const std::int64_t stamp_ns = inputs.sources[sample.source].in_tick_time(
      sample.stamp_ns, inputs.time,
      {.future_ns = scene.future_limit_ns, .age_ns = object.age_limit_ns});
  const SampleLimits limits{inputs.time.now_ns, scene.future_limit_ns};
  const auto cause = refusal(object, sample, stamp_ns, limits, state);
  if (!cause) accept(object, sample, stamp_ns, inputs.time.now_ns, state);
  return cause;
}

// For a tick that cannot know how much time has passed.
void forget_ages(const TickTime& time, Inputs& inputs) noexcept {
  for (SourceClock& source : inputs.sources) source.forget();
  for (TrackedObject& object : inputs.objects) {
    if (object.seen) forget_age(time.now_ns, object);
  }
}

}  // namespace

Inputs initial_inputs(const Scene& scene) {
  Inputs inputs;
  SourceNumbers numbers(scene);
  for (const Object& object : scene.objects) {
    TrackedObject& state = inputs.objects.emplace_back(initial_state(object));
    if (!object.source.empty()) {
      state.owner = InputOwner(numbers.of(SourceName(object.source)));
    }
  }
  return inputs;
}

void ingest(std::span<const PoseSample> samples, const TickTime& time, const Scene& scene,
            Inputs& inputs) noexcept {
  ++inputs.cycle;
  if (time.now_ns < inputs.time.now_ns) forget_ages(time, inputs);
  inputs.time = time;
  for (const PoseSample& sample : samples) {
    if (sample.object >= inputs.objects.size() || scene.objects[sample.object].fixed ||
        sample.source >= kMaxSources) {
      refuse(sample.object, Reject::kUnknownObject, inputs);
    } else if (const auto cause = take(sample, scene, inputs)) {
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
