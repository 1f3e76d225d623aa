#include "monitor/bodies/ingest.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <string_view>

#include "monitor/inputs/input_record.hpp"

namespace clearance {
namespace {

// The stamp of the sample in the tick's time.
template <class Sample>
std::int64_t tick_stamp(const Sample& sample, std::int64_t age_limit_ns, const Scene& scene,
                        Inputs& inputs) noexcept {
  return inputs.sources[sample.source].in_tick_time(
      sample.stamp_ns, inputs.time, {.future_ns = scene.future_limit_ns, .age_ns = age_limit_ns});
}

// The record of the input that the sample names; null if the scene has no such input.
InputRecord* record_of(const PoseSample& sample, Inputs& inputs) noexcept {
  return sample.object < inputs.objects.size() ? &inputs.objects[sample.object].input : nullptr;
}
InputRecord* record_of(const JointSample& sample, Inputs& inputs) noexcept {
  const std::span<TrackedVariable> variables = inputs.robots.variables();
  const bool known = sample.variable < variables.size() && sample.source < kMaxSources;
  return known ? &variables[sample.variable].input : nullptr;
}

// Returns why no sample may place the object.
std::optional<Reject> refuses_samples(std::uint32_t object, const Scene& scene,
                                      const Inputs& inputs) noexcept {
  if (scene.objects[object].fixed || inputs.objects[object].absent) return Reject::kUnknownObject;
  // The poses of what a sensor sees come with its frames.
  if (inputs.robots.follows_joints(object) || scene.objects[object].is_seen())
    return Reject::kOtherSource;
  return std::nullopt;
}

// An object whose rest holds is one that is read, and that samples may place. All that such a
// sample reads of it is in two lines of memory: in large cells, fetching them takes most of its
// time.
std::optional<Reject> take(const PoseSample& sample, const Scene& scene, Inputs& inputs) noexcept {
  if (sample.object >= inputs.objects.size() || sample.source >= kMaxSources)
    return Reject::kUnknownObject;
  TrackedObject& state = inputs.objects[sample.object];
  if (!state.rest.holds) {
    if (!scene.objects[sample.object].is_read) return std::nullopt;
    if (const auto cause = refuses_samples(sample.object, scene, inputs)) return cause;
  }
  const std::int64_t age_limit_ns = inputs.age_limits_ns[sample.object];
  const std::int64_t stamp_ns = tick_stamp(sample, age_limit_ns, scene, inputs);
  const SampleLimits limits{inputs.time.now_ns, scene.future_limit_ns};
  if (take_at_rest(age_limit_ns, sample, stamp_ns, limits, state)) {
    inputs.visits.rest_on_until(sample.object,
                                less(stamp_ns, -std::min(age_limit_ns, inputs.response_left_ns)),
                                limits.now_ns);
    inputs.stamps.set(sample.object, stamp_ns);
    return std::nullopt;
  }
  inputs.visits.visit(sample.object);
  return take(scene.objects[sample.object], sample, stamp_ns, limits, state);
}

// From now on joints place the links of a robot.
void visit_links(Inputs& inputs) noexcept {
  for (std::uint32_t i = 0; i < inputs.objects.size(); ++i) {
    if (inputs.robots.follows_joints(i)) inputs.objects[i].rest.holds = false;
  }
  inputs.visits.visit_all();
}

std::optional<Reject> take(const JointSample& sample, const Scene& scene, Inputs& inputs) noexcept {
  if (record_of(sample, inputs) == nullptr) return Reject::kUnknownObject;
  const JointVariable& variable = scene.variables[sample.variable];
  if (!variable.is_read || variable.is_held()) return std::nullopt;
  const std::int64_t stamp_ns = tick_stamp(sample, variable.age_limit_ns, scene, inputs);
  const std::span<TrackedVariable> variables = inputs.robots.variables();
  const auto cause =
      take(variable, sample, stamp_ns, {inputs.time.now_ns, scene.future_limit_ns},
           variables[sample.variable], variables[variable.first_of_joint].repetition);
  if (!cause && inputs.robots.hear(sample.variable)) visit_links(inputs);
  return cause;
}

void count(Reject cause, InputRecord* input, Inputs& inputs) noexcept {
  const auto index = static_cast<std::size_t>(cause);
  ++inputs.rejected[index];
  if (input != nullptr) ++input->rejected[index];
}

RefusedValue& last_refused(const PoseSample& sample, Inputs& inputs) noexcept {
  return inputs.refused_poses[sample.object];
}
RefusedValue& last_refused(const JointSample& sample, Inputs& inputs) noexcept {
  return inputs.refused_positions[sample.variable];
}

// Fetches what take() reads of an object at rest.
void fetch(const PoseSample& sample, const Inputs& inputs) noexcept {
  if (sample.object >= inputs.objects.size()) return;
  __builtin_prefetch(&inputs.objects[sample.object].pose);
  __builtin_prefetch(&inputs.objects[sample.object].rest, 1);
}
void fetch(const JointSample&, const Inputs&) noexcept {}

template <class Sample>
void take_all(std::span<const Sample> samples, const Scene& scene, Inputs& inputs) noexcept {
  constexpr std::size_t kAhead = 8;  // samples: several misses of the cache at a time
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i + kAhead < samples.size()) fetch(samples[i + kAhead], inputs);
    if (const auto cause = take(samples[i], scene, inputs)) {
      InputRecord* const input = record_of(samples[i], inputs);
      count(*cause, input, inputs);
      if (input != nullptr)
        last_refused(samples[i], inputs) = {*cause, samples[i], inputs.time.now_ns};
    }
  }
}

// Negative: no value is young enough.
std::int64_t response_left(std::int64_t limit_ns, std::int64_t report_delay_ns) noexcept {
  if (limit_ns == Scene::kNoLimit) return limit_ns;
  return report_delay_ns < 0 ? -1 : std::max<std::int64_t>(-1, limit_ns - report_delay_ns);
}

// For a tick that does not know how much time has passed.
void forget_ages(const TickTime& time, Inputs& inputs) noexcept {
  for (SourceClock& source : inputs.sources) source.forget();
  for (CarriedSensor& sensor : inputs.sensors) sensor.lost_ns = CarriedSensor{}.lost_ns;
  for (TrackedObject& object : inputs.objects) {
    if (object.input.has_value) forget_age(time.now_ns, object);
  }
  inputs.robots.forget_ages(time.now_ns);
  inputs.visits.visit_all();
}

}  // namespace

Inputs initial_inputs(const Scene& scene) {
  Inputs inputs{.objects = {},
                .age_limits_ns = {},
                .visits = VisitTimes(scene.objects.size()),
                .stamps = PoseStamps(scene.objects.size()),
                .robots = RobotInputs(scene),
                .sensors = std::vector<CarriedSensor>(scene.sensors.size()),
                .sources = {},
                .refused_poses = std::vector<RefusedValue>(scene.objects.size()),
                .refused_positions = std::vector<RefusedValue>(scene.variables.size())};
  inputs.objects.reserve(scene.objects.size());
  for (const Object& object : scene.objects) {
    inputs.objects.push_back(initial_state(object));
    inputs.age_limits_ns.push_back(object.age_limit_ns);
  }
  SourceNumbers numbers(scene);
  state_owners(scene, numbers, inputs);
  return inputs;
}

void state_owners(const Scene& scene, SourceNumbers& numbers, Inputs& inputs) noexcept {
  const auto state = [&numbers](std::string_view source, InputRecord& input) {
    if (!source.empty()) input.owner = InputOwner(numbers.of(SourceName(source)));
  };
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    state(scene.objects[i].source, inputs.objects[i].input);
  for (std::size_t i = 0; i < scene.variables.size(); ++i)
    state(scene.variables[i].source, inputs.robots.variables()[i].input);
}

void ingest(std::span<const PoseSample> samples, std::span<const JointSample> joints,
            const TickTime& time, const Scene& scene, Inputs& inputs) noexcept {
  ++inputs.cycle;
  if (time.now_ns < inputs.time.now_ns) forget_ages(time, inputs);
  inputs.time = time;
  const std::int64_t left_ns = response_left(scene.response_limit_ns, time.report_delay_ns);
  if (left_ns < inputs.response_left_ns) inputs.visits.visit_all();  // objects that rest, too
  inputs.response_left_ns = left_ns;
  take_all(joints, scene, inputs);
  take_all(samples, scene, inputs);
}

void refuse(std::uint32_t object, Reject cause, Inputs& inputs) noexcept {
  count(cause, object < inputs.objects.size() ? &inputs.objects[object].input : nullptr, inputs);
}

}  // namespace clearance
