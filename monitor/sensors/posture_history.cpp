#include "monitor/sensors/posture_history.hpp"

#include <algorithm>
#include <cmath>

#include "config/scene/plausible_joints.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/joint_metric.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

// The rounding of the interpolation below, relative to the position, rad or m.
constexpr double kInterpolated = 0x1p-50;
double seconds_between(std::int64_t from_ns, std::int64_t to_ns) noexcept {
  return static_cast<double>(elapsed(from_ns, to_ns)) * 1e-9;
}

// No position of a joint in this time is farther from `position`. Between two values, it is off the
// line by no more than T (v^2 - u^2) / 2v, with T their time, u their mean speed and v the largest.
// A point of the line is no farther than half of the distance from `position` over it and back.
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
    const double path = distance(a.value, b.value), mean = path / time, u = std::min(mean, speed);
    const double off = 0.5 * time * (speed - u) * (1.0 + u / speed) + excess(time, speed, mean);
    const double around = distance(position, a.value) + path + distance(position, b.value);
    most = std::max(most, 0.5 * around + off);
  }
  return rounded_up(most);
}

}  // namespace

PostureHistory::PostureHistory(const Scene& scene, SourceNumbers numbers)
    : scene_(scene),
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
  joints_.reserve(scene.variables.size());
  for (std::size_t i = 0; i < scene.variables.size(); ++i)
    joints_.emplace_back(initial_joint(i), kKept);
}

TrackedVariable PostureHistory::initial_joint(std::size_t variable) const {
  TrackedVariable state;
  const std::uint32_t stated = joint_sources_[variable];
  if (stated != kNoSource) state.input.owner = InputOwner(stated);
  return state;
}

// What stands on the object may be far away, so how it turns counts as well: as far as a base turns
// in the time in which the object may have come so far.
TrackedObject PostureHistory::initial_body(std::uint32_t object) const {
  const Object& of = scene_.objects[object];
  TrackedObject state = initial_state(of);
  state.landmarks = Landmarks(of, of.plausible_speed() / kFastestBaseTurn);
  const std::uint32_t stated = object_sources_[object];
  if (stated != kNoSource) state.input.owner = InputOwner(stated);
  return state;
}

void PostureHistory::add(const JointSample& sample, std::int64_t came_ns) {
  if (sample.variable >= joints_.size()) return;
  const JointVariable& of = scene_.variables[sample.variable];
  const SampleOrigin origin{sample.source, sample.namesake, sample.stamp_ns};
  const SampleLimits limits{came_ns, scene_.future_limit_ns};
  JointTrack& track = joints_[sample.variable];
  if (track.is_set_back(origin)) track.begin_anew(initial_joint(sample.variable));
  track.add(sample.position, origin, limits, of.age_limit_ns, [&](TrackedVariable& now) {
    return take(of, sample, sample.stamp_ns, limits, now,
                joints_[of.first_of_joint].now.repetition);
  });
}

void PostureHistory::add(const PoseSample& sample, std::int64_t came_ns) {
  if (sample.object >= scene_.objects.size()) return;
  const Object& of = scene_.objects[sample.object];
  if (of.fixed || of.is_seen()) return;
  auto body = bodies_.find(sample.object);
  if (body == bodies_.end())
    body = bodies_.try_emplace(sample.object, initial_body(sample.object), kKept).first;
  const SampleOrigin origin{sample.source, sample.namesake, sample.stamp_ns};
  const SampleLimits limits{came_ns, scene_.future_limit_ns};
  BodyTrack& track = body->second;
  if (track.is_set_back(origin)) track.begin_anew(initial_body(sample.object));
  const auto& [position, orientation] = sample.world_from_object;
  track.add({position, orientation.normalized()}, origin, limits, of.age_limit_ns,
            [&](TrackedObject& now) { return take(of, sample, sample.stamp_ns, limits, now); });
}

void PostureHistory::forget() {
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].begin_anew(initial_joint(i));
  bodies_.clear();
}

bool PostureHistory::covers(std::int64_t stamp_ns) const noexcept {
  const auto reaches = [&](const auto& series) {
    return series.empty() || series.last().stamp_ns >= stamp_ns ||
           elapsed(series.last().stamp_ns, stamp_ns) > kSourceSilentNs;
  };
  return std::ranges::all_of(
             joints_, [&](const JointTrack& joint) { return reaches(joint.past.values()); }) &&
         std::ranges::all_of(bodies_,
                             [&](const auto& body) { return reaches(body.second.past.values()); });
}

void PostureHistory::place_joint(std::size_t variable, std::int64_t stamp_ns,
                                 std::int64_t within_ns) {
  const JointVariable& of = scene_.variables[variable];
  TrackedVariable& state = variables_[variable];
  state.may_have_moved = 0.0;
  const PastValues<double>& past = joints_[variable].past;
  const auto [before, after] = past.values().around(stamp_ns);
  // Before the first position, nothing is known.
  state.input.has_value = before != nullptr && !past.is_contradicted(stamp_ns);
  if (!state.input.has_value) return;
  const double speed = of.plausible_speed();
  const double since = seconds_between(before->stamp_ns, stamp_ns);
  state.position = before->value;
  state.may_have_moved = path_within(speed, within_ns);
  if (after == nullptr) {
    state.may_have_moved = rounded_up(speed * since + state.may_have_moved);
    return;
  }
  const JointMetric metric(of.wraps);
  if (before != after) {
    const double until = seconds_between(stamp_ns, after->stamp_ns);
    const double path = metric.difference(before->value, after->value);
    state.position += path * (since / (since + until));
    const double rounding = kInterpolated * (std::abs(before->value) + std::abs(after->value));
    state.may_have_moved = rounded_up(deviation(since, until, speed, path / (since + until)) +
                                      rounding + state.may_have_moved);
  }
  if (within_ns == 0) return;
  const double by_values = farthest_within(past.values(), metric, state.position,
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
  if (body == bodies_.end() || body->second.past.is_contradicted(stamp_ns)) return past;
  const PoseSeries& poses = body->second.past.values();
  const auto [before, after] = poses.around(stamp_ns);
  if (before == nullptr) return past;
  const double speed = of.plausible_speed();
  const std::int64_t until_ns = poses.last().stamp_ns, end_ns = stamp_ns + within_ns;
  past.known = true;
  past.world_from_body = clearance::pose_at(poses, std::min(stamp_ns, until_ns));
  const PoseSpread turned = spread(poses, past.world_from_body,
                                   std::max(stamp_ns - within_ns, poses.at(0).stamp_ns), end_ns);
  past.turn_error =
      rounded_up(turned.turn + path_within(kFastestBaseTurn, elapsed(until_ns, end_ns)));
  past.shift_error = path_within(speed, within_ns);
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
    const double shift = deviation_in_space(since, until, speed, distance_between(a, b) / gap);
    past.shift_error = rounded_up(shift + past.shift_error);
  }
  if (gap_ns > kLongGapNs) {
    const double turn =
        deviation_of_turn(since, until, kFastestBaseTurn, angle_between(a, b) / gap);
    past.turn_error =
        std::max(past.turn_error, rounded_up(turn + path_within(kFastestBaseTurn, within_ns)));
  }
  return past;
}

bool PostureHistory::began_by(std::int64_t stamp_ns) const noexcept {
  return std::ranges::all_of(joints_, [&](const JointTrack& joint) {
    const auto& values = joint.past.values();
    return values.empty() || values.around(stamp_ns).before != nullptr;
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
  const auto is_sound = [](const PlacedPostures::Joint& joint) {
    return !joint.known ||
           (std::abs(joint.position) <= kLargestJoint && joint.may_have_moved >= 0.0);
  };
  if (!std::ranges::all_of(placed.joints, is_sound) ||
      !std::ranges::all_of(placed.objects, &PastPose::is_sound))
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
