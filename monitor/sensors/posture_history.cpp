#include "monitor/sensors/posture_history.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/scene/plausible_joints.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// A source that was silent for this long has lost its inputs, ns.
constexpr std::int64_t kSilentNs = 1'000'000'000;
// The rounding of the interpolation below, relative to the position, rad or m.
constexpr double kInterpolated = 0x1p-50;
// The rounding of a product of two poses, relative to the lengths that take part.
constexpr double kComposed = 0x1p-48;

// Two sources whose values differ by no more agree, rad or m.
constexpr double kSameValue = 1e-6;

// Whether the sample is of the source in use. A silent one is replaced.
template <class Series>
bool is_of_source(std::uint32_t source, std::int64_t stamp_ns, const Series& series,
                  std::uint32_t& in_use) {
  const bool is_silent = series.empty() || elapsed(series.last().stamp_ns, stamp_ns) > kSilentNs;
  if (source != in_use && !is_silent) return false;
  in_use = source;
  return true;
}

double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return static_cast<double>(elapsed(from_ns, to_ns)) * 1e-9;
}

// Seconds between two times, whichever is later.
double time_between(std::int64_t a_ns, std::int64_t b_ns) noexcept {
  return std::max(seconds_between(a_ns, b_ns), seconds_between(b_ns, a_ns));
}

// Returns the largest way of a value with this largest speed within this time.
double way_within(double speed, std::int64_t within_ns) noexcept {
  return within_ns > 0 ? rounded_up(speed * 1e-9 * static_cast<double>(within_ns)) : 0.0;
}

// The part of a line's length that this speed does not explain, and the rounding.
double excess(double time_s, double speed, double mean) noexcept {
  return (std::max(0.0, std::abs(mean) - speed) + 0x1p-48 * speed) * time_s;
}

// No position of a joint in this time is farther from `position`. Between two values, it is off the
// line by no more than T (v^2 - u^2) / 2v, with T their time, u their mean speed and v the largest.
// A point of the line is no farther than half of the way from `position` over it and back.
double farthest_within(const StampedSeries<double>& values, const JointMetric& metric,
                       double position, std::int64_t first_ns, std::int64_t last_ns,
                       double speed) noexcept {
  const auto distance = [&](double a, double b) {
    return metric.distance(a, b) + kInterpolated * (std::abs(a) + std::abs(b));
  };
  const auto& first = values.at(0);
  const auto& last = values.last();
  double most = 0.0;
  if (first.stamp_ns >= first_ns)
    most = distance(position, first.value) + speed * seconds_between(first_ns, first.stamp_ns);
  if (last.stamp_ns <= last_ns) {
    most = std::max(
        most, distance(position, last.value) + speed * seconds_between(last.stamp_ns, last_ns));
  }
  for (std::size_t i = std::max<std::size_t>(values.first_from(first_ns), 1); i < values.size();
       ++i) {
    const auto &a = values.at(i - 1), &b = values.at(i);
    if (a.stamp_ns > last_ns) break;
    const double time = seconds_between(a.stamp_ns, b.stamp_ns);
    const double way = distance(a.value, b.value), mean = way / time, u = std::min(mean, speed);
    const double off = 0.5 * time * (speed - u) * (1.0 + u / speed) + excess(time, speed, mean);
    const double around = distance(position, a.value) + way + distance(position, b.value);
    most = std::max(most, 0.5 * around + off);
  }
  return rounded_up(most);
}

}  // namespace

void PostureHistory::Disputed::add(std::int64_t stamp_ns, std::int64_t hold_ns) noexcept {
  const std::int64_t first_ns = less(stamp_ns, hold_ns), last_ns = less(stamp_ns, -hold_ns);
  const bool goes_on = ever && first_ns <= until_ns && last_ns >= from_ns;
  from_ns = goes_on ? std::min(from_ns, first_ns) : first_ns;
  until_ns = goes_on ? std::max(until_ns, last_ns) : last_ns;
  ever = true;
}

bool PostureHistory::Disputed::at(std::int64_t time_ns) const noexcept {
  return ever && from_ns <= time_ns && time_ns <= until_ns;
}

// Values that stay for long where the input cannot be are taken, as in the tick.
// A source that the cell states is never replaced, and only a namesake may contradict it.
template <class Metric>
void PostureHistory::Input<Metric>::take(const SampleOrigin& from, std::uint32_t stated,
                                         const typename Metric::Value& value,
                                         const MotionLimits& limits, const Metric& metric) {
  const std::int64_t stamp_ns = from.stamp_ns;
  const bool is_rival = stated != kNoSource && from.source != stated;
  if (is_rival && (from.namesake != stated || values.empty())) return;
  if (is_rival || !is_of_source(from.source, stamp_ns, values, source)) {
    const auto& last = values.last();
    const double within = limits.fastest * time_between(last.stamp_ns, stamp_ns) + kSameValue;
    if (!metric.stay_within(within, last.value, value)) disputed.add(stamp_ns, kSilentNs);
    return;
  }
  if (!values.empty() && stamp_ns > values.last().stamp_ns) {
    const auto& last = values.last();
    if (can_reach(metric, last.value, value, elapsed(last.stamp_ns, stamp_ns), limits)) {
      elsewhere.clear();
    } else {
      disputed.add(stamp_ns, limits.age_limit_ns);
      if (!elsewhere.add(value, stamp_ns, limits, metric)) return;
      values.clear();
    }
  }
  values.add(stamp_ns, value);
}

double PastPose::error(double radius) const noexcept {
  return rounded_up(shift_error + turn_error * radius);
}

PastPose carried(const PastPose& parent, const Pose& parent_from_child, double shift_error,
                 double turn_error) noexcept {
  const double arm = parent_from_child.position.norm();
  PastPose child = parent;
  child.world_from_body = compose(parent.world_from_body, parent_from_child);
  child.world_from_body.orientation.normalize();
  const double rounding = kComposed * (arm + parent.world_from_body.position.norm());
  child.shift_error =
      rounded_up(parent.shift_error + parent.turn_error * arm + shift_error + rounding);
  child.turn_error = rounded_up(parent.turn_error + turn_error + kComposed);
  return child;
}

// The value is within speed times the time of both ends, and the line has come mean times the time.
double deviation(double before_s, double after_s, double speed, double mean) noexcept {
  if (before_s <= 0.0 || after_s <= 0.0) return 0.0;
  const double u = std::min(std::abs(mean), speed);
  const double ahead = std::min(before_s * (speed - u), after_s * (speed + u));
  const double behind = std::min(before_s * (speed + u), after_s * (speed - u));
  // The differences above lose digits where both speeds are nearly equal.
  return rounded_up(std::max(ahead, behind) + excess(before_s + after_s, speed, mean));
}

// With x between a and b, and p on the line at its time: |x - p| is no more than |x - a| + |a - p|.
// By Stewart's theorem, its square is no more than before_s after_s (speed^2 - mean^2).
double deviation_in_space(double before_s, double after_s, double speed, double mean) noexcept {
  if (before_s <= 0.0 || after_s <= 0.0) return 0.0;
  const double u = std::min(std::abs(mean), speed);
  const double square = before_s * after_s * (speed + u) * (speed - u + 0x1p-48 * speed);
  return std::min(deviation_of_turn(before_s, after_s, speed, mean),
                  rounded_up(std::sqrt(square) + excess(before_s + after_s, speed, mean)));
}

double deviation_of_turn(double before_s, double after_s, double speed, double mean) noexcept {
  if (before_s <= 0.0 || after_s <= 0.0) return 0.0;
  const double u = std::min(std::abs(mean), speed);
  return rounded_up((speed + u) * std::min(before_s, after_s) +
                    excess(before_s + after_s, speed, mean));
}

PostureHistory::PostureHistory(const Scene& scene, SourceNumbers numbers)
    : scene_(scene),
      joints_(scene.variables.size()),
      judged_(scene.variables.size()),
      variables_(scene.variables.size()),
      bases_(scene.robots.size()),
      objects_(scene.objects.size()),
      kinematics_(scene.robots) {
  const auto number = [&numbers](const std::string& source) {
    return source.empty() ? kNoSource : numbers.of(SourceName(source));
  };
  for (const JointVariable& variable : scene.variables)
    joint_sources_.push_back(number(variable.source));
  for (const Object& object : scene.objects) object_sources_.push_back(number(object.source));
}

// A refusal because another source is in use is no fault of the input.
void PostureHistory::judge(const JointSample& sample) {
  const JointVariable& of = scene_.variables[sample.variable];
  TrackedVariable& state = judged_[sample.variable];
  if (elapsed(sample.stamp_ns, state.input.stamp_ns) > kSetBackNs) state = {};
  const std::uint32_t stated = joint_sources_[sample.variable];
  if (stated != kNoSource && sample.source != stated) return;
  const auto cause = clearance::take(of, sample, sample.stamp_ns, {sample.stamp_ns, 0}, state,
                                     judged_[of.first_of_joint].repetition);
  if (cause == Reject::kFrozen || cause == Reject::kOtherWay || cause == Reject::kOutsideLimits) {
    const std::int64_t hold_ns = state.plausibility.agree_for_ns({.age_limit_ns = of.age_limit_ns});
    joints_[sample.variable].disputed.add(sample.stamp_ns, hold_ns);
  }
}

void PostureHistory::judge(const PoseSample& sample) {
  const Object& of = scene_.objects[sample.object];
  TrackedObject& state = judged_bodies_.try_emplace(sample.object, initial_state(of)).first->second;
  if (elapsed(sample.stamp_ns, state.input.stamp_ns) > kSetBackNs) state = initial_state(of);
  const std::uint32_t stated = object_sources_[sample.object];
  if (stated != kNoSource && sample.source != stated) return;
  const auto cause = clearance::take(of, sample, sample.stamp_ns, {sample.stamp_ns, 0}, state);
  if (cause == Reject::kFrozen || cause == Reject::kOtherWay) {
    const std::int64_t hold_ns = state.plausibility.agree_for_ns({.age_limit_ns = of.age_limit_ns});
    bodies_[sample.object].disputed.add(sample.stamp_ns, hold_ns);
  }
}

void PostureHistory::add(const JointSample& sample) {
  if (sample.variable >= joints_.size() || !(std::abs(sample.position) <= kLargestJoint)) return;
  const JointVariable& of = scene_.variables[sample.variable];
  const double fastest = of.plausible_speed();
  const double sent = sample.has_velocity ? std::abs(sample.velocity) : 0.0;
  const MotionLimits limits{
      .fastest = sent > fastest ? std::min(sent, of.speed_tolerance * fastest) : fastest,
      .age_limit_ns = of.age_limit_ns};
  joints_[sample.variable].take({sample.source, sample.namesake, sample.stamp_ns},
                                joint_sources_[sample.variable], sample.position, limits,
                                JointMetric(of.wraps));
  judge(sample);
}

void PostureHistory::add(const PoseSample& sample) {
  if (sample.object >= scene_.objects.size()) return;
  const Object& object = scene_.objects[sample.object];
  const Pose& pose = sample.world_from_object;
  const bool is_pose = pose.position.allFinite() && pose.orientation.coeffs().allFinite() &&
                       std::abs(pose.orientation.norm() - 1.0) <= kSampleUnitTolerance;
  if (object.fixed || object.is_seen() || !is_pose) return;
  const double fastest = object.plausible_speed();
  const MotionLimits limits{.fastest = fastest,
                            .age_limit_ns = object.may_jump
                                                ? std::numeric_limits<std::int64_t>::max()
                                                : object.age_limit_ns};
  bodies_[sample.object].take({sample.source, sample.namesake, sample.stamp_ns},
                              object_sources_[sample.object],
                              {pose.position, pose.orientation.normalized()}, limits,
                              CarrierMetric{kFastestBaseTurn / fastest});
  judge(sample);
}

void PostureHistory::forget() {
  std::ranges::fill(joints_, Joint{});
  std::ranges::fill(judged_, TrackedVariable{});
  bodies_.clear();
  judged_bodies_.clear();
}

bool PostureHistory::covers(std::int64_t stamp_ns) const noexcept {
  const auto reaches = [&](const auto& series) {
    return series.empty() || series.last().stamp_ns >= stamp_ns ||
           elapsed(series.last().stamp_ns, stamp_ns) > kSilentNs;
  };
  return std::ranges::all_of(joints_, [&](const Joint& joint) { return reaches(joint.values); }) &&
         std::ranges::all_of(bodies_,
                             [&](const auto& body) { return reaches(body.second.values); });
}

void PostureHistory::place_joint(std::size_t variable, std::int64_t stamp_ns,
                                 std::int64_t within_ns) {
  const JointVariable& of = scene_.variables[variable];
  TrackedVariable& state = variables_[variable];
  state.may_have_moved = 0.0;
  const auto [before, after] = joints_[variable].values.around(stamp_ns);
  // Before the first position, nothing is known.
  state.input.has_value = before != nullptr && !joints_[variable].disputed.at(stamp_ns);
  if (!state.input.has_value) return;
  const double speed = of.plausible_speed();
  const double since = seconds_between(before->stamp_ns, stamp_ns);
  state.position = before->value;
  state.may_have_moved = way_within(speed, within_ns);
  if (after == nullptr) {
    state.may_have_moved = rounded_up(speed * since + state.may_have_moved);
    return;
  }
  const JointMetric metric(of.wraps);
  if (before != after) {
    const double until = seconds_between(stamp_ns, after->stamp_ns);
    const double way = metric.difference(before->value, after->value);
    state.position += way * (since / (since + until));
    const double rounding = kInterpolated * (std::abs(before->value) + std::abs(after->value));
    state.may_have_moved = rounded_up(deviation(since, until, speed, way / (since + until)) +
                                      rounding + state.may_have_moved);
  }
  if (within_ns == 0) return;
  const double by_values = farthest_within(joints_[variable].values, metric, state.position,
                                           stamp_ns - within_ns, stamp_ns + within_ns, speed);
  state.may_have_moved = std::min(state.may_have_moved, by_values);
}

// An object is nowhere faster than its largest speed, and neither is any point of it. What stands
// on it may be far away, so how it turns counts as well: between two poses that
// are near in time, as they show it; else, at the largest speed of a base.
PastPose PostureHistory::pose_at(std::uint32_t object, std::int64_t stamp_ns,
                                 std::int64_t within_ns) const {
  PastPose past;
  const Object& of = scene_.objects[object];
  if (of.fixed) return {.known = true, .world_from_body = of.world_from_object};
  const auto body = bodies_.find(object);
  if (body == bodies_.end() || body->second.disputed.at(stamp_ns)) return past;
  const PoseSeries& poses = body->second.values;
  const auto [before, after] = poses.around(stamp_ns);
  if (before == nullptr) return past;
  const double speed = of.plausible_speed();
  const std::int64_t until_ns = poses.last().stamp_ns, end_ns = stamp_ns + within_ns;
  past.known = true;
  past.world_from_body = clearance::pose_at(poses, std::min(stamp_ns, until_ns));
  const PoseSpread turned = spread(poses, past.world_from_body,
                                   std::max(stamp_ns - within_ns, poses.at(0).stamp_ns), end_ns);
  past.turn_error =
      rounded_up(turned.turn + way_within(kFastestBaseTurn, elapsed(until_ns, end_ns)));
  past.shift_error = way_within(speed, within_ns);
  const double since = seconds_between(before->stamp_ns, stamp_ns);
  if (after == nullptr) {
    past.shift_error = rounded_up(speed * since + past.shift_error);
    return past;
  }
  const std::int64_t gap_ns = elapsed(before->stamp_ns, after->stamp_ns);
  if (gap_ns == 0) return past;
  const double until = seconds_between(stamp_ns, after->stamp_ns), gap = seconds(gap_ns);
  const Pose &a = before->value, &b = after->value;
  if (gap_ns > kLongGapNs || !same_pose(a, b)) {
    const double shift = deviation_in_space(since, until, speed, way_between(a, b) / gap);
    past.shift_error = rounded_up(shift + past.shift_error);
  }
  if (gap_ns > kLongGapNs) {
    const double turn =
        deviation_of_turn(since, until, kFastestBaseTurn, angle_between(a, b) / gap);
    past.turn_error =
        std::max(past.turn_error, rounded_up(turn + way_within(kFastestBaseTurn, within_ns)));
  }
  return past;
}

bool PostureHistory::began_by(std::int64_t stamp_ns) const noexcept {
  return std::ranges::all_of(joints_, [&](const Joint& joint) {
    return joint.values.empty() || joint.values.around(stamp_ns).before != nullptr;
  });
}

void PostureHistory::place(std::int64_t stamp_ns, std::int64_t within_ns) {
  for (std::size_t i = 0; i < joints_.size(); ++i) place_joint(i, stamp_ns, within_ns);
  for (std::uint32_t i = 0; i < objects_.size(); ++i) objects_[i] = pose_at(i, stamp_ns, within_ns);
  place_links();
}

bool PostureHistory::place(const PlacedPostures& placed) {
  if (placed.joints.size() != variables_.size() || placed.objects.size() != objects_.size())
    return false;
  for (std::size_t i = 0; i < variables_.size(); ++i) {
    variables_[i].input.has_value = placed.joints[i].known;
    variables_[i].position = placed.joints[i].position;
    variables_[i].may_have_moved = placed.joints[i].may_have_moved;
  }
  objects_ = placed.objects;
  place_links();
  return true;
}

PlacedPostures PostureHistory::placed() const {
  PlacedPostures placed;
  for (const TrackedVariable& joint : variables_)
    placed.joints.push_back({joint.input.has_value, joint.position, joint.may_have_moved});
  placed.objects = objects_;
  return placed;
}

void PostureHistory::place_links() {
  for (std::size_t robot = 0; robot < bases_.size(); ++robot) {
    const RobotBase& base = scene_.robots[robot].base;
    if (base.kind != RobotBase::Kind::kObject) continue;
    const PastPose& past = objects_[base.object];
    bases_[robot] = {};
    bases_[robot].known = past.known;
    bases_[robot].pose = past.world_from_body;
    bases_[robot].unobserved_shift = past.shift_error;
    bases_[robot].unobserved_turn = past.turn_error;
  }
  kinematics_.place(variables_, bases_);
}

PastPose PostureHistory::link(std::uint32_t robot, std::uint32_t link) const noexcept {
  const LinkState& state = kinematics_.links(robot)[link];
  return {.known = state.known,
          .world_from_body = state.pose,
          .shift_error = rounded_up(state.unobserved_shift + state.shift_error),
          .turn_error = rounded_up(state.unobserved_turn + state.turn_error)};
}

PastPose PostureHistory::object(std::uint32_t object) const noexcept { return objects_[object]; }

}  // namespace clearance
