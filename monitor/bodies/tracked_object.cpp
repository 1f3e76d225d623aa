#include "monitor/bodies/tracked_object.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/presence.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/inputs/mean_twist.hpp"

namespace clearance {
namespace {

// Limits of the squared norm.
constexpr double kLeastUnit = (1.0 - kSampleUnitTolerance) * (1.0 - kSampleUnitTolerance);
constexpr double kMostUnit = (1.0 + kSampleUnitTolerance) * (1.0 + kSampleUnitTolerance);
// The displacement that counts as a discontinuity, larger than any cell. Accumulating it would lose
// digits permanently. After 1e4 km, which is 1 m/s for four months, the accumulated displacement
// still resolves 1e-8 m.
constexpr double kJump = 1e4;  // m

bool usable(const Vec3& v) noexcept {
  return std::abs(v.x()) <= kLargestInSample && std::abs(v.y()) <= kLargestInSample &&
         std::abs(v.z()) <= kLargestInSample;
}

// Checks all but the orientation.
bool usable(const PoseSample& sample) noexcept {
  return usable(sample.world_from_object.position) &&
         (!sample.has_twist || (usable(sample.twist.linear) && usable(sample.twist.angular)));
}

// Samples may be off unit length by 1e-3, distance queries accept 1e-6. The tolerance is half of
// that, because queries compose two poses.
Pose as_queries_take_it(const Pose& pose) noexcept {
  Pose out = pose;
  if (!(std::abs(pose.orientation.squaredNorm() - 1.0) <= kUnitTolerance)) {
    out.orientation.normalize();
  }
  return out;
}

bool is_zero(const Twist& twist) noexcept {
  return twist.linear == Vec3::Zero() && twist.angular == Vec3::Zero();
}

// The sample is not a pose at all, whichever source sent it.
std::optional<Reject> malformed(const PoseSample& sample) noexcept {
  if (!usable(sample)) return Reject::kNonFinite;
  const Eigen::Quaterniond& orientation = sample.world_from_object.orientation;
  const double squared = orientation.squaredNorm();
  if (squared >= kLeastUnit && squared <= kMostUnit) return std::nullopt;
  return orientation.coeffs().allFinite() ? Reject::kNotUnit : Reject::kNonFinite;
}

// One sample of an object, as a candidate for clearance::take.
struct PoseCandidate {
  const Object& object;
  const PoseSample& sample;
  std::int64_t stamp_ns;
  TrackedObject& state;
  MotionLimits limits = motion_limits(object);
  Pose pose = {};     // the sample's pose, normalised; set by malformed()
  bool same = false;  // it is the pose in use; set by implausible()

  [[nodiscard]] std::optional<Reject> malformed() noexcept {
    const auto cause = clearance::malformed(sample);
    if (!cause) pose = as_queries_take_it(sample.world_from_object);
    return cause;
  }
  [[nodiscard]] bool disputes() const noexcept;
  [[nodiscard]] std::optional<Reject> implausible() noexcept;
  void use() noexcept;
  void rest_from_now() noexcept;
  [[nodiscard]] std::int64_t agree_for_ns() const noexcept {
    return state.plausibility.agree_for_ns(limits);
  }
};

bool PoseCandidate::disputes() const noexcept {
  const double speed = state.landmarks.length(state.twist) +
                       (sample.has_twist ? state.landmarks.length(sample.twist) : 0.0);
  return is_disputed(state.landmarks, state.pose, state.input.stamp_ns, pose, stamp_ns, speed,
                     limits);
}

std::optional<Reject> PoseCandidate::implausible() noexcept {
  same = state.input.has_value && same_pose(pose, state.pose);
  if (object.may_jump) return std::nullopt;
  if (!can_have_twist(object, state.landmarks, sample)) return Reject::kTooFast;
  return state.plausibility.refuses(
      {.value = pose, .rate = sample.has_twist ? &sample.twist : nullptr, .stamp_ns = stamp_ns},
      state.input.has_value ? &state.pose : nullptr, state.input.stamp_ns, same, state.repetition,
      limits, state.landmarks);
}

void PoseCandidate::use() noexcept {
  const std::int64_t interval_ns = elapsed(state.input.stamp_ns, stamp_ns);
  if (sample.has_twist) {
    state.twist = sample.twist;
    state.twist_known = true;
  } else if (state.input.has_value && interval_ns > 0) {  // equal stamps give no velocity
    // A mean over a time is the velocity of half that time ago. It is accepted for as long as a
    // pose of that age is.
    state.twist_known = interval_ns / 2 <= object.age_limit_ns;
    const double seconds = static_cast<double>(interval_ns) * 1e-9;
    state.twist =
        state.twist_known ? mean_twist(state.pose, sample.world_from_object, seconds) : Twist{};
  }
  state.pose = pose;
  state.plausibility.use(pose, stamp_ns, !state.input.has_value, limits);
  if (same && state.twist_known && is_zero(state.twist)) rest_from_now();
}

void PoseCandidate::rest_from_now() noexcept {
  constexpr std::int64_t kAlways = std::numeric_limits<std::int64_t>::max();
  const bool has_rate = sample.has_twist;
  state.rest = {.holds = true,
                .has_twist = has_rate,
                .until_ns = object.may_jump ? kAlways
                                            : state.plausibility.unchanged_until(
                                                  has_rate, state.repetition, limits)};
}

}  // namespace

// Each coordinate is compared: maxCoeff() may pass over NaN.
bool is_usable(const Pose& pose) noexcept {
  return (pose.position.array().abs() <= kLargestCoordinate).all() && is_unit(pose.orientation);
}

bool TrackedObject::is_sound(const TrackedObject& own) const noexcept {
  const bool flags =
      are_flags(moved, newly_known, discontinuous, plain, absent, rest.holds, rest.has_twist) &&
      are_flags(twist_known, follows_joints, joints_late, joints_contradicted,
                pose_last_tick_known);
  const bool bounds = may_have_moved >= 0.0 && unobserved >= 0.0 && displacement >= 0.0 &&
                      (!input.has_value || may_have_moved <= unobserved) &&
                      accumulated_last_tick >= 0.0 && accumulated >= accumulated_last_tick &&
                      accumulated < kInfinity && bend >= 0.0 && accumulated_turn >= 0.0 &&
                      accumulated_turn < kInfinity && unobserved_by_joints >= 0.0 &&
                      motion.shift >= 0.0 && motion.turn >= 0.0;
  const bool values = is_usable(pose) && is_usable(pose_last_tick) && is_usable(pose_before) &&
                      twist.linear.allFinite() && twist.angular.allFinite();
  const bool is_where_it_is = own.input.ages || same_pose(pose, own.pose);
  const bool is_there = !absent || (own.input.ages && !input.has_value);
  return flags && bounds && values && is_where_it_is && is_there && input.is_sound(own.input) &&
         plausibility.is_sound();
}

TrackedObject initial_state(const Object& object) {
  TrackedObject state;
  state.landmarks = Landmarks(object);
  if (!object.fixed) return state;
  state.input.has_value = state.pose_last_tick_known = true;
  state.pose = state.pose_last_tick = state.pose_before = object.world_from_object;
  state.input.ages = false;
  state.twist_known = true;  // at rest
  state.plain = true;
  return state;
}

std::optional<Reject> take(const Object& object, const PoseSample& sample, std::int64_t stamp_ns,
                           const SampleLimits& limits, TrackedObject& state) noexcept {
  if (state.rest.holds && state.rest.has_twist) state.plausibility.catch_up(state.input.stamp_ns);
  state.rest.holds = false;
  return take(PoseCandidate{object, sample, stamp_ns, state},
              {sample.source, sample.namesake, stamp_ns}, limits, object.age_limit_ns, state.input);
}

// The checks that are left out would find what they found at the sample before.
bool take_at_rest(std::int64_t age_limit_ns, const PoseSample& sample, std::int64_t stamp_ns,
                  const SampleLimits& limits, TrackedObject& state) noexcept {
  InputRecord& input = state.input;
  if (!state.rest.holds || stamp_ns > state.rest.until_ns || stamp_ns < input.stamp_ns ||
      elapsed(input.stamp_ns, stamp_ns) > 2 * age_limit_ns ||
      elapsed(limits.now_ns, stamp_ns) > limits.future_ns ||
      sample.source != input.owner.source() || input.contradiction.holds(limits.now_ns)) {
    return false;
  }
  if (sample.has_twist != state.rest.has_twist ||
      !same_pose(sample.world_from_object, state.pose) ||
      (sample.has_twist && !is_zero(sample.twist))) {
    return false;
  }
  input.owner.take(sample.source, limits.now_ns);
  input.stamp_ns = stamp_ns;
  return true;
}

std::optional<Reject> see(const Pose& world_from_sensor, std::int64_t stamp_ns,
                          const SampleLimits& limits, TrackedObject& state) noexcept {
  if (state.absent) return Reject::kUnknownObject;
  const PoseSample sample{.world_from_object = world_from_sensor, .twist = {}};
  if (const auto cause = malformed(sample)) return cause;
  if (elapsed(limits.now_ns, stamp_ns) > limits.future_ns) return Reject::kFuture;
  if (state.input.has_value && stamp_ns < state.input.stamp_ns) return Reject::kBackwards;
  make_absent(state);
  make_present(state);
  state.pose = as_queries_take_it(world_from_sensor);
  state.twist_known = true;  // of what it sees: at rest, so that pairs have the speed of the part
  state.input.stamp_ns = stamp_ns;
  state.input.has_value = true;
  return std::nullopt;
}

bool may_be_anywhere(const Object& object, std::int64_t now_ns,
                     const TrackedObject& state) noexcept {
  const std::int64_t age_ns = state.input.age_ns(now_ns);
  return age_ns > object.age_limit_ns &&
         rounded_up(object.max_speed * seconds(age_ns)) > state.bounding_radius;
}

void follow(const LinkState& link, const Object& object, std::int64_t now_ns, TrackedObject& state,
            std::int64_t response_left_ns) noexcept {
  const bool known = link.known && link.error(state.bounding_radius) <= object.pose_error;
  const bool answered = elapsed(link.stamp_ns, now_ns) <= response_left_ns;
  state.follows_joints = true;
  state.joints_late = !known || link.late || !answered;
  state.unobserved_by_joints =
      known && answered ? link.may_have_moved(state.bounding_radius) : kInfinity;
  if (!known) return;
  if (link.late && answered && !link.contradicted && object.max_speed < kInfinity) {
    const double age_s = seconds(elapsed(link.stamp_ns, now_ns));
    state.unobserved_by_joints =
        std::min(state.unobserved_by_joints, rounded_up(object.max_speed * age_s));
  }
  state.joints_contradicted = link.contradicted;
  state.pose = as_queries_take_it(link.pose);
  state.input.stamp_ns = link.stamp_ns;
  state.twist = link.twist;
  state.twist_known = link.velocity_known;
  state.input.has_value = true;
}

void forget_age(std::int64_t now_ns, TrackedObject& state) noexcept {
  state.input.forget_age(now_ns);
  state.plausibility.forget_age(state.pose, state.input.stamp_ns);
  state.rest.holds = false;
  state.repetition.add(false, now_ns);
}

void advance(const Object& object, std::int64_t now_ns, TrackedObject& state, Trust trust,
             std::int64_t response_left_ns) noexcept {
  InputRecord& input = state.input;
  if (object.fixed || !input.has_value) return;
  const double unobserved_before = state.pose_last_tick_known ? state.may_have_moved : kInfinity;
  state.newly_known = !(unobserved_before < kInfinity);
  state.moved = !state.pose_last_tick_known || !same_pose(state.pose_last_tick, state.pose);
  state.motion = state.moved && state.pose_last_tick_known
                     ? motion_between(state.pose_last_tick, state.pose)
                     : Motion{};
  if (state.moved) {
    state.pose_before = state.newly_known ? state.pose : state.pose_last_tick;
    state.pose_last_tick = state.pose;
  }
  state.pose_last_tick_known = true;

  input.advance(now_ns, object.age_limit_ns, response_left_ns);
  if (trust == Trust::kNever) input.contradicted = input.late = true;
  if (state.follows_joints) {
    input.contradicted = state.joints_contradicted;
    input.late = state.joints_late;
    state.may_have_moved = state.unobserved_by_joints;
  } else {
    const bool may_move = input.late || (object.is_seen() && object.max_speed < kInfinity);
    const bool is_anywhere = input.contradicted || input.unanswered ||
                             (input.late && trust == Trust::kWhileOnTime) ||
                             (object.is_seen() && may_be_anywhere(object, now_ns, state));
    state.may_have_moved = is_anywhere ? kInfinity
                           : may_move ? rounded_up(object.max_speed * seconds(input.age_ns(now_ns)))
                                      : 0.0;
  }
  state.unobserved =
      state.newly_known ? state.may_have_moved : std::max(unobserved_before, state.may_have_moved);
}

void displace(double bounding_radius, TrackedObject& state) noexcept {
  state.bounding_radius = bounding_radius;
  state.displacement = state.moved ? moved_at_most(state.motion, bounding_radius) : 0.0;
  state.bend = state.moved ? bend_at_most(state.motion, bounding_radius) : 0.0;
  state.accumulated_last_tick = state.accumulated;
  if (state.motion.turn > 0.0)
    state.accumulated_turn = rounded_up(state.accumulated_turn + state.motion.turn);
  state.discontinuous = false;
  if (!(state.displacement < kJump)) {
    state.discontinuous =
        !state.newly_known && (bounding_radius < kInfinity || !(state.motion.shift < kJump));
    state.displacement = kInfinity;
  } else if (state.displacement > 0.0) {
    state.accumulated = rounded_up(state.accumulated + state.displacement);
  }
  state.plain = state.input.has_value && !state.newly_known && !state.input.late &&
                !state.discontinuous && state.unobserved == 0.0;
}

}  // namespace clearance
