// One variable of a joint as the tick knows it: the position in use, how old it is, and how far the
// joint may be from it by now.
#pragma once

#include <cstdint>
#include <optional>

#include "config/scene/robot.hpp"
#include "monitor/inputs/input_record.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {

struct TrackedVariable {
  InputRecord input;
  bool velocity_known = false;
  double position = 0.0;  // rad or m
  // As sent with the position, else from the last two. Not known, and zero, after the first, and
  // after a gap longer than twice the age limit.
  double velocity = 0.0;
  // Since its stamp, rad or m, at most: 0 unless late; infinite: neither a speed nor limits bound
  // it.
  double may_have_moved = 0.0;
  double sent_speed = 0.0;  // with the position; 0: none was
};

// Takes a sample into use; else says why it must not be used, and notes what that says of the
// joint. `stamp_ns` is the sample's, in the tick's time.
[[nodiscard]] std::optional<Reject> take(const JointVariable& variable, const JointSample& sample,
                                         std::int64_t stamp_ns, const SampleLimits& limits,
                                         TrackedVariable& state) noexcept;

// Ends the tick's input: age, lateness, and how far it may have moved.
void advance(const JointVariable& variable, std::int64_t now_ns, TrackedVariable& state) noexcept;

}  // namespace clearance
