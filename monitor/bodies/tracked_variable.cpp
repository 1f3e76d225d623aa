#include "monitor/bodies/tracked_variable.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_body.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/elapsed.hpp"

namespace clearance {
namespace {

// Measured velocities are noisy: they may exceed the largest speed by this factor.
constexpr double kNoisy = 1.5;

bool usable(double x) noexcept { return std::abs(x) <= kLargestJoint; }

// True if the sample has a velocity that the joint can have. Drivers write NaN for what they do not
// measure.
bool has_usable_velocity(const JointVariable& variable, const JointSample& sample) noexcept {
  return sample.has_velocity && usable(sample.velocity) &&
         std::abs(sample.velocity) <=
             std::max(variable.speed_tolerance, kNoisy) * variable.plausible_speed();
}

// The magnitude of the sent velocity; 0 if there is none, or if it is not a usable number.
double speed_of(const JointSample& sample) noexcept {
  return sample.has_velocity && usable(sample.velocity) ? std::abs(sample.velocity) : 0.0;
}

// A sent velocity may exceed the velocity limit, which is wrong in many descriptions. The excess is
// capped, so that a leap cannot excuse itself by an arbitrary velocity. A velocity from positions
// does not count here, because the positions are in question.
MotionLimits motion_limits(const JointVariable& variable, double sent) noexcept {
  const double fastest = variable.plausible_speed();
  return {.fastest = std::max(fastest, std::min(sent, variable.speed_tolerance * fastest)),
          .usual = variable.max_speed < kInfinity ? variable.max_speed : kUsualSpeed,
          .age_limit_ns = variable.age_limit_ns,
          .frozen_limit_ns = variable.frozen_limit_ns};
}

// One sample of a variable, as a candidate for clearance::take.
struct PositionCandidate {
  const JointVariable& variable;
  const JointSample& sample;
  std::int64_t stamp_ns;
  TrackedVariable& state;
  Repetition& of_joint;
  JointMetric metric{variable.wraps};
  MotionLimits limits = motion_limits(variable, std::max(state.sent_speed, speed_of(sample)));

  [[nodiscard]] std::optional<Reject> malformed() const noexcept {
    return usable(sample.position) ? std::nullopt : std::optional(Reject::kNonFinite);
  }

  [[nodiscard]] bool disputes() const noexcept {
    return is_disputed(metric, state.position, state.input.stamp_ns, sample.position, stamp_ns,
                       std::abs(state.velocity) + speed_of(sample), limits);
  }

  [[nodiscard]] std::optional<Reject> implausible() const noexcept {
    if (sample.position < variable.lower - variable.limit_tolerance ||
        sample.position > variable.upper + variable.limit_tolerance) {
      state.outside_limits = true;
      return Reject::kOutsideLimits;
    }
    const bool has_value = state.input.has_value;
    const bool has_rate = has_usable_velocity(variable, sample);
    if (!has_rate && speed_of(sample) > 0.0) state.plausibility.distrust_rates();
    return state.plausibility.refuses({.value = sample.position,
                                       .rate = has_rate ? &sample.velocity : nullptr,
                                       .stamp_ns = stamp_ns},
                                      has_value ? &state.position : nullptr, state.input.stamp_ns,
                                      has_value && sample.position == state.position, of_joint,
                                      limits, metric);
  }

  // Without a sent velocity, the mean since the last position is used; two equal stamps give none.
  // A mean over an interval is the velocity of half an interval ago, so it is late when that is.
  void use() const noexcept {
    const std::int64_t interval_ns = elapsed(state.input.stamp_ns, stamp_ns);
    const bool sent = has_usable_velocity(variable, sample);
    state.velocities_contradict =
        !variable.velocity_is_difference && state.plausibility.rates_contradict();
    if (sent && !state.velocities_contradict) {
      state.velocity = sample.velocity;
      state.velocity_known = true;
    } else if (state.input.has_value && interval_ns > 0) {
      state.velocity_known = interval_ns / 2 <= variable.age_limit_ns;
      state.velocity = state.velocity_known ? metric.difference(state.position, sample.position) /
                                                  seconds(interval_ns)
                                            : 0.0;
    }
    state.sent_speed = speed_of(sample);
    note_braking();
    state.position = sample.position;
    state.outside_limits = false;
    state.plausibility.use(sample.position, stamp_ns, !state.input.has_value, limits);
  }

  // A joint that becomes faster is not believed to brake, until its sender begins anew. A statement
  // that is interrupted goes on, unless the joint has stood or become faster meanwhile.
  void note_braking() const noexcept {
    const double speed = std::max(std::abs(state.velocity), state.sent_speed);
    const double still = still_speed(variable);
    if (!sample.stopping) {
      state.is_stopping = false;
      if (speed <= still || speed > kNoisy * state.slowest_braking)
        state.slowest_braking = kInfinity;
      return;
    }
    if (state.slowest_braking == kInfinity) {
      state.braking_from = speed;
      state.braking_since_ns = stamp_ns;
    }
    state.slowest_braking = std::min(state.slowest_braking, speed);
    state.is_stopping =
        state.velocity_known && speed <= std::max(still, kNoisy * state.slowest_braking);
  }

  [[nodiscard]] std::int64_t agree_for_ns() const noexcept {
    return state.plausibility.agree_for_ns(limits);
  }
};

// The distance to the farther one of the two position limits, m or rad. Infinity if there are no
// limits, or if the joint has been found outside of them.
double largest_distance(const JointVariable& variable, const TrackedVariable& state) noexcept {
  if (state.outside_limits) return kInfinity;
  const double distance =
      std::max(variable.upper - state.position, state.position - variable.lower);
  return rounded_up(distance + variable.limit_tolerance);
}

}  // namespace

bool TrackedVariable::is_sound(const TrackedVariable& own) const noexcept {
  const bool are_speeds =
      may_have_moved >= 0.0 && sent_speed >= 0.0 && slowest_braking >= 0.0 && braking_from >= 0.0;
  return are_flags(velocity_known, is_stopping, velocities_contradict, outside_limits) &&
         input.is_sound(own.input) && usable(position) && std::isfinite(velocity) && are_speeds &&
         std::isfinite(sent_speed) && plausibility.is_sound();
}

std::optional<Reject> take(const JointVariable& variable, const JointSample& sample,
                           std::int64_t stamp_ns, const SampleLimits& limits,
                           TrackedVariable& state, Repetition& of_joint) noexcept {
  return take(PositionCandidate{variable, sample, stamp_ns, state, of_joint},
              {sample.source, sample.namesake, stamp_ns}, limits, variable.age_limit_ns,
              state.input);
}

void forget_age(std::int64_t now_ns, TrackedVariable& state) noexcept {
  state.input.forget_age(now_ns);
  state.plausibility.forget_age(state.position, state.input.stamp_ns);
  state.repetition.add(false, now_ns);
}

void advance(const JointVariable& variable, std::int64_t now_ns, TrackedVariable& state,
             std::int64_t response_left_ns) noexcept {
  InputRecord& input = state.input;
  if (!input.has_value) return;
  input.advance(now_ns, variable.age_limit_ns, response_left_ns);
  state.may_have_moved = 0.0;
  if (!input.late) return;
  // If the measured velocity exceeds the velocity limit, the limit does not bound the joint.
  const double fastest = std::max(variable.max_speed, std::abs(state.velocity));
  const double distance =
      input.contradicted ? kInfinity : rounded_up(fastest * seconds(input.age_ns(now_ns)));
  state.may_have_moved = std::min(distance, largest_distance(variable, state));
}

}  // namespace clearance
