#include "monitor/kinematics/tracked_variable.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_body.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/motion/elapsed.hpp"

namespace clearance {
namespace {

// By no more than this factor are velocity limits of descriptions taken to be too low.
constexpr double kLimitTooLow = 4.0;

bool usable(double x) noexcept { return std::abs(x) <= kLargestJoint; }

// Without one, or one that is a number: 0.
double speed_of(const JointSample& sample) noexcept {
  return sample.has_velocity && usable(sample.velocity) ? std::abs(sample.velocity) : 0.0;
}

// The age limit is how far off in time the cell lets a position be. What is sent as its velocity
// may exceed the limit, which many descriptions have wrong, but not so far that any leap would
// excuse itself; what positions say may not: that is in question.
bool can_reach(const JointVariable& variable, const JointSample& sample, std::int64_t stamp_ns,
               const TrackedVariable& state) noexcept {
  const double time = seconds(elapsed(state.stamp_ns, stamp_ns)) + seconds(variable.age_limit_ns);
  const double sent = std::max(state.sent_speed, speed_of(sample));
  const double fastest =
      std::max(variable.max_speed, std::min(sent, kLimitTooLow * variable.max_speed));
  return std::abs(sample.position - state.position) <= rounded_up(fastest * time);
}

// What is against a position of the joint's source, given those before it.
std::optional<Reject> contradiction(const JointVariable& variable, const JointSample& sample,
                                    std::int64_t stamp_ns, const SampleLimits& limits,
                                    const TrackedVariable& state) noexcept {
  if (elapsed(limits.now_ns, stamp_ns) > limits.future_ns) return Reject::kFuture;
  if (!state.seen) return std::nullopt;
  if (stamp_ns < state.stamp_ns) return Reject::kBackwards;
  return can_reach(variable, sample, stamp_ns, state) ? std::nullopt
                                                      : std::optional(Reject::kTooFast);
}

// The farther of its two limits; none that it was seen to exceed.
double room(const JointVariable& variable, double position) noexcept {
  if (position < variable.lower || position > variable.upper) return kInfinity;
  return rounded_up(std::max(variable.upper - position, position - variable.lower));
}

}  // namespace

std::optional<Reject> refusal(const JointVariable& variable, const JointSample& sample,
                              std::int64_t stamp_ns, const SampleLimits& limits,
                              TrackedVariable& state) noexcept {
  if (!usable(sample.position)) return Reject::kNonFinite;
  if (state.owner.refuses(sample.source, limits.now_ns, variable.age_limit_ns)) {
    return Reject::kOtherSource;
  }
  const auto cause = contradiction(variable, sample, stamp_ns, limits, state);
  // Of positions that come in another order than they were made one is as good as the other.
  const bool reordered =
      cause == Reject::kBackwards && elapsed(stamp_ns, state.stamp_ns) <= variable.age_limit_ns;
  if (cause && !reordered) state.contradiction.meet(limits.now_ns, variable.age_limit_ns);
  return cause;
}

// A velocity that is no number is none: drivers fill in NaN for what they do not measure. The same
// stamp again says nothing about speed; a mean over some time is the velocity of half that time
// ago.
void accept(const JointVariable& variable, const JointSample& sample, std::int64_t stamp_ns,
            std::int64_t now_ns, TrackedVariable& state) noexcept {
  const std::int64_t apart_ns = elapsed(state.stamp_ns, stamp_ns);
  if (sample.has_velocity && usable(sample.velocity)) {
    state.velocity = sample.velocity;
    state.velocity_known = true;
  } else if (state.seen && apart_ns > 0) {
    state.velocity_known = apart_ns / 2 <= variable.age_limit_ns;
    state.velocity =
        state.velocity_known ? (sample.position - state.position) / seconds(apart_ns) : 0.0;
  }
  state.sent_speed = speed_of(sample);
  state.position = sample.position;
  state.contradiction.agree();
  state.stamp_ns = stamp_ns;
  state.owner.take(sample.source, now_ns);
  state.seen = true;
}

void forget_age(std::int64_t now_ns, TrackedVariable& state) noexcept {
  state.stamp_ns = less(now_ns, kForgottenNs);
  state.owner.forget_age(now_ns);
  state.contradiction.forget_age();
}

void advance(const JointVariable& variable, std::int64_t now_ns, TrackedVariable& state) noexcept {
  if (!state.seen) return;
  state.age_ns = elapsed(state.stamp_ns, now_ns);
  state.contradicted = state.contradiction.holds(now_ns);
  state.late = state.contradicted || state.age_ns > variable.age_limit_ns;
  state.may_have_moved = 0.0;
  if (!state.late) return;
  // A joint that was seen to go faster than its description says is not bound by that.
  const double fastest = std::max(variable.max_speed, std::abs(state.velocity));
  const double way = state.contradicted ? kInfinity : rounded_up(fastest * seconds(state.age_ns));
  state.may_have_moved = std::min(way, room(variable, state.position));
}

}  // namespace clearance
