// One variable of a joint: the position in use, its age, and a bound of the motion since its stamp.
#pragma once

#include <cstdint>
#include <optional>

#include "config/scene/robot.hpp"
#include "core/convex_body.hpp"
#include "monitor/bodies/joint_metric.hpp"
#include "monitor/inputs/input_record.hpp"
#include "monitor/inputs/joint_batch.hpp"
#include "monitor/inputs/plausibility.hpp"

namespace clearance {

struct TrackedVariable {
  InputRecord input;
  bool velocity_known = false;
  double position = 0.0;  // rad or m
  // The velocity sent with the position, else the mean between the last two positions. It is zero
  // and not known after the first position, and after a gap longer than twice the age limit. If the
  // sent velocities contradict the positions, it is the mean, too.
  double velocity = 0.0;
  // Bound of the motion since its stamp, rad or m. It is 0 unless late, and infinite if neither a
  // speed nor limits bound the motion.
  double may_have_moved = 0.0;
  double sent_speed = 0.0;  // that was sent with the position; 0: none was sent
  // Since its brakes have been stated to act: the least speed, rad/s or m/s; infinity: they are
  // not, or it has stood or become faster since. The speed at first, and the stamp of that
  // position.
  double slowest_braking = kInfinity, braking_from = 0.0;
  std::int64_t braking_since_ns = 0;
  bool is_stopping = false;            // its brakes act, and its speed has not risen since
  bool velocities_contradict = false;  // the sent velocities say less than the positions show
  bool outside_limits = false;         // a position was refused for that since one was taken
  Repetition repetition;               // of all positions of the joint; at its first variable
  Plausibility<JointMetric> plausibility;

  // `own`: before anything was heard.
  [[nodiscard]] bool is_sound(const TrackedVariable& own) const noexcept;
};

// A joint that is no faster than this stands: velocities are noisy. rad/s or m/s.
[[nodiscard]] inline double still_speed(const JointVariable& variable) noexcept {
  return 1e-3 * (variable.max_speed < kInfinity ? variable.max_speed : 1.0);
}

// Takes a sample into use, or returns why it must not be used and updates the contradiction state.
// `stamp_ns` is the sample's stamp in the tick's time. `of_joint` is the repetition of the whole
// joint.
[[nodiscard]] std::optional<Reject> take(const JointVariable& variable, const JointSample& sample,
                                         std::int64_t stamp_ns, const SampleLimits& limits,
                                         TrackedVariable& state, Repetition& of_joint) noexcept;

// The age of the position in use is not known any more: it is late until the next one comes.
void forget_age(std::int64_t now_ns, TrackedVariable& state) noexcept;

// Ends the tick's input: sets age, lateness, and the bound of the unobserved motion.
void advance(const JointVariable& variable, std::int64_t now_ns, TrackedVariable& state,
             std::int64_t response_left_ns = kAnyAge) noexcept;

}  // namespace clearance
