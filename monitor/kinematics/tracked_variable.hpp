// One variable of a joint as the tick knows it: the position in use, how old it is, and how far the
// joint may be from it by now.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "config/scene/robot.hpp"
#include "monitor/joint_batch.hpp"
#include "monitor/kinematics/contradiction.hpp"
#include "monitor/kinematics/input_owner.hpp"
#include "monitor/pose_batch.hpp"

namespace clearance {

struct TrackedVariable {
  bool seen = false;          // some position is in use
  bool late = false;          // it is older than its limit, or contradicted
  bool contradicted = false;  // by positions that the joint cannot have
  bool velocity_known = false;
  double position = 0.0;  // rad or m
  // As sent with the position, else from the last two. Not known, and zero, after the first, and
  // after a gap longer than twice the age limit.
  double velocity = 0.0;
  // Since its stamp, rad or m, at most: 0 unless late; infinite: neither a speed nor limits bound
  // it.
  double may_have_moved = 0.0;
  std::int64_t stamp_ns = 0;  // in the tick's time
  std::int64_t age_ns = -1;   // now - stamp, never negative; -1: never seen

  double sent_speed = 0.0;  // with the position; 0: none was
  InputOwner owner;         // who sends it
  Contradiction contradiction;
  std::array<std::uint64_t, kRejects> rejected{};
};

// Why this sample must not be used, if so; notes what that says of the joint. `stamp_ns` is the
// sample's, in the tick's time.
[[nodiscard]] std::optional<Reject> refusal(const JointVariable& variable,
                                            const JointSample& sample, std::int64_t stamp_ns,
                                            const SampleLimits& limits,
                                            TrackedVariable& state) noexcept;

// Takes an unrefused sample into use.
void accept(const JointVariable& variable, const JointSample& sample, std::int64_t stamp_ns,
            std::int64_t now_ns, TrackedVariable& state) noexcept;

// Nobody can say how old the position in use is: it is late until the next one comes.
void forget_age(std::int64_t now_ns, TrackedVariable& state) noexcept;

// Ends the tick's input: age, lateness, and how far it may have moved.
void advance(const JointVariable& variable, std::int64_t now_ns, TrackedVariable& state) noexcept;

}  // namespace clearance
