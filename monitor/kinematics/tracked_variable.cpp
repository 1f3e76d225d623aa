#include "monitor/kinematics/tracked_variable.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_body.hpp"
#include "monitor/inputs/elapsed.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// The largest factor by which a sent velocity may exceed the velocity limit of the description.
constexpr double kLimitTooLow = 4.0;

bool usable(double x) noexcept { return std::abs(x) <= kLargestJoint; }

// The magnitude of the sent velocity; 0 if there is none, or if it is not a usable number.
double speed_of(const JointSample& sample) noexcept {
  return sample.has_velocity && usable(sample.velocity) ? std::abs(sample.velocity) : 0.0;
}

// The age limit is the largest timing error that the cell accepts for a position. A sent velocity
// may exceed the velocity limit, which is wrong in many descriptions. The excess is capped, so that
// a leap cannot excuse itself by an arbitrary velocity. A velocity from positions does not count
// here, because the positions are in question.
bool can_reach(const JointVariable& variable, const JointSample& sample, std::int64_t stamp_ns,
               const TrackedVariable& state) noexcept {
  const double time =
      seconds(elapsed(state.input.stamp_ns, stamp_ns)) + seconds(variable.age_limit_ns);
  const double sent = std::max(state.sent_speed, speed_of(sample));
  const double fastest =
      std::max(variable.max_speed, std::min(sent, kLimitTooLow * variable.max_speed));
  return std::abs(sample.position - state.position) <= rounded_up(fastest * time);
}

// One sample of a variable, as a candidate for clearance::take.
struct PositionCandidate {
  const JointVariable& variable;
  const JointSample& sample;
  std::int64_t stamp_ns;
  TrackedVariable& state;

  [[nodiscard]] std::optional<Reject> malformed() const noexcept {
    return usable(sample.position) ? std::nullopt : std::optional(Reject::kNonFinite);
  }

  [[nodiscard]] std::optional<Reject> implausible() const noexcept {
    const bool possible = !state.input.has_value || can_reach(variable, sample, stamp_ns, state);
    return possible ? std::nullopt : std::optional(Reject::kTooFast);
  }

  // A velocity that is not a number counts as absent: drivers write NaN for what they do not
  // measure. Two equal stamps give no velocity. A mean over a time is the velocity of half that
  // time ago.
  void use() const noexcept {
    const std::int64_t apart_ns = elapsed(state.input.stamp_ns, stamp_ns);
    if (sample.has_velocity && usable(sample.velocity)) {
      state.velocity = sample.velocity;
      state.velocity_known = true;
    } else if (state.input.has_value && apart_ns > 0) {
      state.velocity_known = apart_ns / 2 <= variable.age_limit_ns;
      state.velocity =
          state.velocity_known ? (sample.position - state.position) / seconds(apart_ns) : 0.0;
    }
    state.sent_speed = speed_of(sample);
    state.position = sample.position;
  }

  [[nodiscard]] std::int64_t agree_for_ns() const noexcept { return variable.age_limit_ns; }
};

// The larger distance to the two position limits; infinity if the position is outside them.
double room(const JointVariable& variable, double position) noexcept {
  if (position < variable.lower || position > variable.upper) return kInfinity;
  return rounded_up(std::max(variable.upper - position, position - variable.lower));
}

}  // namespace

std::optional<Reject> take(const JointVariable& variable, const JointSample& sample,
                           std::int64_t stamp_ns, const SampleLimits& limits,
                           TrackedVariable& state) noexcept {
  return take(PositionCandidate{variable, sample, stamp_ns, state}, {sample.source, stamp_ns},
              limits, variable.age_limit_ns, state.input);
}

void advance(const JointVariable& variable, std::int64_t now_ns, TrackedVariable& state) noexcept {
  InputRecord& input = state.input;
  if (!input.has_value) return;
  input.advance(now_ns, variable.age_limit_ns);
  state.may_have_moved = 0.0;
  if (!input.late) return;
  // The velocity limit does not bound a joint whose measured velocity exceeds it.
  const double fastest = std::max(variable.max_speed, std::abs(state.velocity));
  const double way = input.contradicted ? kInfinity : rounded_up(fastest * seconds(input.age_ns));
  state.may_have_moved = std::min(way, room(variable, state.position));
}

}  // namespace clearance
