// A tick is a sequence of stages. Each stage reads the results of those before it:
//
//   ingest         samples of poses and joints -> Inputs: the values in use of objects and joints;
//                  frames of sensors           -> the contents of their objects
//   displace       Inputs                      -> Displacements: how far each object moved
//   pose           moved objects               -> parts placed in the world
//   allow          time, Contacts              -> Contacts: which allowances are in force
//   cull           Displacements               -> Culling: updated pairs, bounds of all others
//   schedule       updated pairs, budget       -> Schedule: pairs to evaluate now, budget to keep
//   evaluate       Schedule                    -> PairTable: evaluated bounds of the urgent pairs
//   cross          updated pairs               -> ZoneCrossings: pairs that the sweep must decide
//   refresh        Schedule, kept budget       -> PairTable, Evaluated: round-robin
//   sweep          ZoneCrossings, kept budget  -> ZoneCrossings: bounds since the last tick
//   cull again     PairTable                   -> Culling: active pairs that are far now
//   judge          PairTable, ZoneCrossings    -> Contacts: whether contacts are as allowed
//   conclude       PairTable, ZoneCrossings    -> Zones, minimum, published pairs of the Report
//   separate       published pairs             -> zones with `separation` of the Report
//   stop           inputs, published pairs     -> stops of robots in the Report
//   differentiate  published pairs, links      -> gradients of the Report
//   report         all of these                -> the rest of the Report, which no stage reads
//   self-test      constant memory             -> SelfTest: whether a bit of it has flipped
#include "monitor/tick/monitor.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "monitor/bodies/presence.hpp"
#include "monitor/bodies/take_over.hpp"
#include "monitor/interface/invariant.hpp"
#include "monitor/tick/monitor_state.hpp"
#include "monitor/tick/stage_borders.hpp"

namespace clearance {
Monitor::Monitor(const Scene& scene, const Monitor* similar)
    : state_(std::make_unique<State>(scene, similar == nullptr ? nullptr : similar->state_.get())) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].absent) state_->make_absent(i);
  }
}
Monitor::~Monitor() = default;

const Report& Monitor::tick(std::span<const PoseSample> samples,
                            std::span<const JointSample> joints, const TickTime& time) noexcept {
  State& s = *state_;
  if (s.displacer.is_first()) s.begin_first_tick();
  if (time.now_ns < s.inputs.time.now_ns) {
    for (State::Shown& sensor : s.shown) sensor.clock.forget();
  }
  ingest(samples, joints, time, s.scene, s.inputs);
  s.take_frames();
  s.displacer.displace(s.inputs);
  s.add_presence_changes();
  const Displacements& displaced = s.displacer.result();
  pose_parts(s.inputs.objects, displaced.changed, s.first_part, s.parts);
  if (s.errors.any()) s.errors.place(s.inputs.objects, s.inputs.robots);

  const OpenTick tick(s.inputs.objects, s.parts, s.inputs.cycle, s.table, s.inputs.time.now_ns,
                      s.clouds.get(), s.errors.any() ? &s.errors : nullptr);
  check_displaced(displaced.changed, s.first_part, tick);

  s.contacts.begin_tick(s.inputs.cycle, s.inputs.time.now_ns);
  if (s.clouds != nullptr) s.clouds->begin_tick();
  Budget budget(s.scene.budget);
  s.culling.cull(displaced.changed, s.evaluated.smallest_upper, tick, budget);
  check_updated(s.culling, tick);
  const Schedule schedule = s.scheduler.schedule(s.culling, tick, budget);
  const std::uint32_t kept_for_refresh = budget.reserve(schedule.kept);
  const bool urgent_done = s.scheduler.evaluate_urgent(schedule, s.culling, tick, budget);
  s.crossings.find(s.culling.updated(), s.zones, tick);
  const std::uint32_t kept_for_sweep = budget.reserve(s.crossings.queries());
  budget.release(kept_for_refresh);
  s.evaluated = s.scheduler.refresh(schedule, urgent_done, s.culling, tick, budget);
  budget.release(kept_for_sweep);
  s.crossings.sweep(s.culling.updated(), s.zones, tick, budget);
  s.culling.cull_active(tick);

  judge(tick, s.crossings, s.contacts);
  s.conclusion =
      conclude(s.published, displaced, s.culling, s.crossings, tick, s.zones, s.report.pairs);
  s.separations.write(s.inputs.objects, s.inputs.cycle, time.report_delay_ns, s.report);
  s.stops.write(s.inputs, s.clouds.get(), s.contacts, s.report);
  s.differentiation.differentiate(s.report.pairs, tick, s.inputs.robots, s.report.gradients);
  s.finish_report(s.scene.budget - budget.left());
  check_report(s.report, s.table.most_error());
  s.self_test.tick();
  return s.report;
}

bool Monitor::take_over(const Monitor& before, const SceneMap& map,
                        SourceNumbers& numbers) noexcept {
  State& s = *state_;
  CLEARANCE_INVARIANT(s.displacer.is_first());
  if (!numbers.add_named(s.named_sources)) return false;
  clearance::take_over(before.state_->inputs, map, s.scene, numbers, s.inputs);
  s.contacts.take_over(before.state_->contacts, map);
  s.zones.take_over(before.state_->zones, map);
  s.zones.count_absent(s.inputs.objects);
  for (std::size_t i = 0; i < before.state_->shown.size(); ++i) {
    const std::uint32_t now = map.objects_now[before.state_->scene.sensors[i].object];
    if (now == SceneMap::kNone || !s.scene.objects[now].is_seen()) continue;
    s.shown[s.scene.objects[now].sensor].clock = before.state_->shown[i].clock;
    s.inputs.sensors[s.scene.objects[now].sensor].lost_ns =
        before.state_->inputs.sensors[i].lost_ns;
  }
  if (s.scene.revision != before.state_->scene.revision) return true;
  for (std::size_t i = 0; i < s.shown.size(); ++i)
    s.shown[i].frame = before.state_->shown[i].in_use;
  return true;
}

void Monitor::save(StateWriter& out) const {
  const State& s = *state_;
  clearance::save(s.inputs, out);
  s.contacts.save(out);
  s.zones.save(out);
  for (const State::Shown& shown : s.shown) {
    out.put(shown.frame.content);
    out.put(shown.clock);
  }
}

bool Monitor::restore(StateReader& in) noexcept {
  State& s = *state_;
  CLEARANCE_INVARIANT(s.displacer.is_first());
  clearance::restore(in, s.scene, s.inputs);
  s.contacts.restore(in, s.inputs.time.now_ns);
  s.zones.restore(in);
  if (in.good()) s.zones.count_absent(s.inputs.objects);
  for (State::Shown& shown : s.shown) {
    in.take(shown.awaited);
    in.take(shown.clock);
    in.expect(shown.clock.is_sound());
  }
  return in.complete();
}

std::uint64_t Monitor::awaited_frame(std::uint32_t sensor) const noexcept {
  return state_->shown[sensor].awaited;
}

std::uint64_t Monitor::cycle() const noexcept { return state_->inputs.cycle; }

void Monitor::refuse(std::uint32_t object, Reject cause) noexcept {
  clearance::refuse(object, cause, state_->inputs);
}

bool Monitor::set_absent(std::uint32_t object, bool absent) noexcept {
  State& s = *state_;
  if (object >= s.scene.objects.size() || s.scene.objects[object].fixed) return false;
  TrackedObject& state = s.inputs.objects[object];
  if (state.absent == absent) return true;
  if (absent) {
    s.make_absent(object);
  } else {
    make_present(state);
    s.note_presence(object);
  }
  return true;
}

bool Monitor::show(std::uint32_t sensor, const SensorFrame& frame) noexcept {
  State& s = *state_;
  if (sensor >= s.shown.size() || frame.cloud == nullptr || !frame.cloud->shows_place())
    return false;
  s.shown[sensor].frame = frame;
  s.shown[sensor].awaited = 0;
  return true;
}

bool Monitor::uses(const SeenCloud* cloud) const noexcept {
  const State& s = *state_;
  for (std::uint32_t sensor = 0; sensor < s.shown.size(); ++sensor) {
    if (s.shown[sensor].frame.cloud == cloud || s.clouds->content(sensor).cloud == cloud)
      return true;
  }
  return false;
}

SensorFrame Monitor::frame_in_use(std::uint32_t sensor) const noexcept {
  return state_->shown[sensor].in_use;
}

PairReport Monitor::pair(std::uint32_t pair) const noexcept { return state_->pair_report(pair); }

InputAge Monitor::input_age(std::uint32_t object) const noexcept {
  const TrackedObject& state = state_->inputs.objects[object];
  return {.age_ns = state.input.age_ns(state_->inputs.time.now_ns),
          .stale = state.input.late,
          .contradicted = state.input.contradicted,
          .follows_joints = state.follows_joints,
          .absent = state.absent,
          .source = state.input.owner.source(),
          .other_source = state.input.owner.other_source(state_->inputs.time.now_ns),
          .takeovers = state.input.owner.takeovers(),
          .former_source = state.input.owner.former_source()};
}

// The joints of a robot without any joint position are not advanced, so they are stale here.
InputAge Monitor::joint_age(std::uint32_t variable) const noexcept {
  const TrackedVariable& state = state_->inputs.robots.variables()[variable];
  return {.age_ns = state.input.age_ns(state_->inputs.time.now_ns),
          .stale = !state.input.has_value || state.input.late,
          .contradicted = state.input.contradicted,
          .source = state.input.owner.source(),
          .other_source = state.input.owner.other_source(state_->inputs.time.now_ns),
          .takeovers = state.input.owner.takeovers(),
          .former_source = state.input.owner.former_source(),
          .velocities_contradict = state.velocities_contradict};
}

const std::array<std::uint64_t, kRejects>& Monitor::rejected_joints(
    std::uint32_t variable) const noexcept {
  return state_->inputs.robots.variables()[variable].input.rejected;
}
const std::array<std::uint64_t, kRejects>& Monitor::rejected(std::uint32_t object) const noexcept {
  return state_->inputs.objects[object].input.rejected;
}

std::span<const RefusedValue> Monitor::refused_poses() const noexcept {
  return state_->inputs.refused_poses;
}
std::span<const RefusedValue> Monitor::refused_positions() const noexcept {
  return state_->inputs.refused_positions;
}

const Pose& Monitor::pose(std::uint32_t object) const noexcept {
  return state_->inputs.objects[object].pose;
}

PresentPose Monitor::present_pose(std::uint32_t object) const noexcept {
  using enum PresentPose::State;
  const InputAge age = input_age(object);
  if (age.absent) return {kAbsent};
  if (age.contradicted) return {kContradicted};
  if (age.age_ns < 0) return {kUnknown};
  if (age.stale) return {kLate};
  return {kUsable, pose(object)};
}

PresentPose Monitor::present_link(std::uint32_t robot, std::uint32_t link) const noexcept {
  using enum PresentPose::State;
  const LinkState& state = state_->inputs.robots.links(robot)[link];
  if (state.contradicted || state_->inputs.robots.is_denied(robot)) return {kContradicted};
  if (!state.known) return {kUnknown};
  if (state.late) return {kLate};
  return {kUsable, state.pose};
}

PresentJoint Monitor::present_joint(std::uint32_t variable) const noexcept {
  using enum PresentPose::State;
  const InputAge age = joint_age(variable);
  const std::uint32_t robot = state_->scene.variables[variable].robot;
  if (age.contradicted || state_->inputs.robots.is_denied(robot)) return {kContradicted};
  if (age.age_ns < 0) return {kUnknown};
  if (age.stale) return {kLate};
  const TrackedVariable& joint = state_->inputs.robots.variables()[variable];
  return {kUsable, joint.position,
          joint.velocity_known ? joint.velocity : std::numeric_limits<double>::quiet_NaN()};
}

std::span<const ContactReport> Monitor::contacts() const noexcept {
  return state_->contacts.reports();
}

std::int64_t Monitor::stamp_ns(std::uint32_t object) const noexcept {
  return state_->inputs.objects[object].input.stamp_ns;
}

void Monitor::State::finish_report(std::uint32_t queries) noexcept {
  report.cycle = inputs.cycle;
  report.now_ns = inputs.time.now_ns;
  report.clock_offset_ns = inputs.time.clock_offset_ns;
  report.report_delay_ns = inputs.time.report_delay_ns;
  report.newest_pose_ns = displacer.result().newest_pose_ns;
  report.oldest_pose_ns = displacer.result().oldest_pose_ns;
  report.rejected = inputs.rejected;
  std::ranges::copy(zones.reports(), report.zones.begin());
  std::ranges::copy(contacts.reports(), report.contacts.begin());
  std::ranges::copy(hidden.reports(), report.hidden.begin());

  report.queries = queries;
  report.oldest_evaluation_cycles = inputs.cycle - evaluated.oldest_refresh;
  count_pairs();
  write_minimum();
}

void Monitor::State::make_absent(std::uint32_t object) noexcept {
  clearance::make_absent(inputs.objects[object]);
  culling.forget_object(object, table);
  note_presence(object);
}

// A frame that helps no pair any more leaves, since a partner would have to build it before it
// joins. The object is unknown until the next frame comes.
void Monitor::State::drop_useless_frame(std::uint32_t sensor) noexcept {
  constexpr std::int64_t kKeptNs = 1'000'000'000;  // after it has become late
  if (shown[sensor].in_use.cloud == nullptr) return;
  const std::uint32_t object = scene.sensors[sensor].object;
  const TrackedObject& state = inputs.objects[object];
  const std::int64_t earlier_ns = less(inputs.time.now_ns, kKeptNs);
  if (state.input.has_value && !may_be_anywhere(scene.objects[object], earlier_ns, state)) return;
  shown[sensor].in_use = {};
  clouds->set(sensor, {});
  hidden.forget(sensor);
}

// The former frame is forgotten as an object that goes away. What is seen now may be elsewhere.
void Monitor::State::take_frames() noexcept {
  for (std::uint32_t sensor = 0; sensor < shown.size(); ++sensor) {
    drop_useless_frame(sensor);
    const SensorFrame frame = std::exchange(shown[sensor].frame, {});
    if (frame.cloud == nullptr) continue;
    const std::uint32_t object = scene.sensors[sensor].object;
    const std::int64_t stamp_ns = shown[sensor].clock.in_tick_time(
        frame.stamp_ns, inputs.time,
        {.future_ns = scene.future_limit_ns, .age_ns = scene.objects[object].age_limit_ns});
    const std::int64_t earliest_ns = less(stamp_ns, scene.sensors[sensor].stamp_error_ns);
    const SampleLimits limits{inputs.time.now_ns, scene.future_limit_ns};
    if (const auto cause =
            see(frame.world_from_sensor, earliest_ns, limits, inputs.objects[object])) {
      clearance::refuse(object, *cause, inputs);
      continue;
    }
    if (scene.sensors[sensor].is_witness)
      inputs.robots.witness(sensor, frame.robots, scene.sensors[sensor].witness_frames);
    culling.forget_object(object, table);
    clouds->set(sensor, {frame.cloud, frame.pose_error, scene.sensors[sensor].greatest_depth});
    shown[sensor].in_use = frame;
    inputs.sensors[sensor].carrier = frame.carrier;
    hidden.take(sensor, *frame.cloud);
    inputs.visits.visit(object);
  }
}

void Monitor::State::note_presence(std::uint32_t object) noexcept {
  inputs.visits.visit(object);
  if (std::ranges::find(presence_changed, object) == presence_changed.end())
    presence_changed.push_back(object);
  zones.count_absent(inputs.objects);
}

// No pair has waited longer for its refresh than this monitor has run. All objects count as
// changed, whether their presence is or not.
void Monitor::State::begin_first_tick() noexcept {
  if (inputs.cycle > 0) {
    for (PairEntry& entry : table.entries) entry.refreshed_cycle = inputs.cycle;
  }
  presence_changed.clear();
}

// An object that has become absent, or present without a pose, has not moved. It is therefore not
// in `changed`.
void Monitor::State::add_presence_changes() noexcept {
  for (const std::uint32_t object : presence_changed) {
    if (!inputs.objects[object].input.has_value) displacer.add_changed(object);
  }
  presence_changed.clear();
}

void Monitor::State::count_pairs() noexcept {
  const auto known = static_cast<std::uint32_t>(culling.known_pairs().known());
  const auto fresh = static_cast<std::uint32_t>(culling.known_pairs().fresh());
  const auto present = static_cast<std::uint32_t>(culling.known_pairs().present());
  report.evaluated = conclusion.evaluated;
  report.carried = fresh - conclusion.evaluated;
  report.stale = known - fresh;
  report.unknown = present - known;
  // Every pair is counted exactly once, so the differences above are not negative.
  CLEARANCE_INVARIANT(conclusion.evaluated <= fresh && fresh <= known && known <= present);
  CLEARANCE_INVARIANT(absent_pairs(report) == report.pairs_total - present);
}

void Monitor::State::write_minimum() noexcept {
  const GlobalMinimum& minimum = conclusion.minimum;
  report.lower_all = report.unknown > 0 ? -kInfinity : minimum.lower();
  report.swept_lower_all = report.unknown > 0 ? -kInfinity : minimum.swept_lower();
  report.minimum_known = minimum.known();
  report.minimum_certified = minimum.certified() && report.stale == 0 && report.unknown == 0;
  if (minimum.known()) {
    write_pair(minimum.pair(), minimum.bounds(), view(), report.minimum);
  } else {
    report.minimum = unknown_report();
  }
}

PairBounds Monitor::State::bounds(std::uint32_t pair) const noexcept {
  const bool closely = published.is_published[pair] || zone_levels.has(pair);
  const auto precision =
      closely ? SweptPrecision::kByRelativeDisplacement : SweptPrecision::kByDisplacement;
  return bounds_in_tick(pair, precision, crossings, view());
}

PairReport Monitor::State::pair_report(std::uint32_t pair) const noexcept {
  PairReport written;
  write_pair(pair, bounds(pair), view(), written);
  return written;
}

}  // namespace clearance
