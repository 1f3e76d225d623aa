#include "monitor/kinematics/tracked_variable.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_polyhedron.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/motion/elapsed.hpp"

namespace clearance {
namespace {

bool usable(double x) noexcept { return std::abs(x) <= kLargestJoint; }

// A joint that was seen to go faster than its description says is not bound by that.
double fastest(const JointVariable& variable, const TrackedVariable& state) noexcept {
  return std::max(variable.max_speed, std::abs(state.velocity));
}

// The age limit is how far off in time the cell lets a position be.
bool can_reach(const JointVariable& variable, const JointSample& sample, std::int64_t stamp_ns,
               const TrackedVariable& state) noexcept {
  const double time = seconds(elapsed(state.stamp_ns, stamp_ns)) + seconds(variable.age_limit_ns);
  return std::abs(sample.position - state.position) <= rounded_up(fastest(variable, state) * time);
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
  if (elapsed(limits.now_ns, stamp_ns) > limits.future_ns) return Reject::kFuture;
  if (state.seen && stamp_ns < state.stamp_ns) return Reject::kBackwards;
  state.contradicted = state.seen && !can_reach(variable, sample, stamp_ns, state);
  return state.contradicted ? std::optional(Reject::kTooFast) : std::nullopt;
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
  state.position = sample.position;
  state.stamp_ns = stamp_ns;
  state.owner.take(sample.source, now_ns);
  state.seen = true;
}

void forget_age(std::int64_t now_ns, TrackedVariable& state) noexcept {
  state.stamp_ns = less(now_ns, kForgottenNs);
  state.owner.forget_age(now_ns);
}

void advance(const JointVariable& variable, std::int64_t now_ns, TrackedVariable& state) noexcept {
  if (!state.seen) return;
  state.age_ns = elapsed(state.stamp_ns, now_ns);
  state.late = state.contradicted || state.age_ns > variable.age_limit_ns;
  state.may_have_moved =
      state.late ? std::min(rounded_up(fastest(variable, state) * seconds(state.age_ns)),
                            room(variable, state.position))
                 : 0.0;
}

}  // namespace clearance
