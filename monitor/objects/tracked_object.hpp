// One object of the scene as the tick knows it: the pose in use, where it came from and how it
// moves.
#pragma once

#include <cstdint>
#include <optional>

#include "config/scene/scene.hpp"
#include "monitor/inputs/input_record.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/kinematics/forward_kinematics.hpp"
#include "monitor/motion/displacement.hpp"
#include "monitor/motion/interpolated_motion.hpp"
#include "monitor/motion/relative_displacement.hpp"
#include "monitor/objects/plausibility.hpp"

namespace clearance {

struct TrackedObject {
  // What every pair asks of both its objects each tick comes first: one cache line, to
  // `accumulated_turn`.
  bool moved = false;          // it is not that of the last tick
  bool first_seen = false;     // nothing was known of it at the last tick
  bool discontinuous = false;  // something was, but that is farther off than anything moves
  // None of the exceptions: known and on time, now and at the last tick, and no discontinuity
  // between.
  bool plain = false;
  bool absent = false;  // known not to be there (presence.hpp); then no pose is in use
  // Since its stamp, m, at most: 0 unless late; infinity: no speed is stated.
  double may_have_moved = 0.0;
  double unseen_since = 0.0;  // the larger of that at the last tick, if known then, and now, m
  // No point of it has moved farther than these: since the last tick (infinity: not known),
  // and in all, up to the last tick and up to now, leaving out the ticks of which that is not
  // known. All m, set by displace().
  double displacement = 0.0, accumulated_last_tick = 0.0, accumulated = 0.0;
  // At any instant since the last tick no point of it was farther than this from where it would
  // have been had it gone straight and evenly from its place then to its place now, m.
  double bend = 0.0;
  double accumulated_turn = 0.0;  // Motion::turn, in all
  double reach = kInfinity;       // no point of it is farther from its origin, m; set by displace()
  InputRecord input;  // of its poses; of a link that follows joints, what they say of them

  // As sent, but for an orientation that is off unit length by more than 5e-7.
  Pose pose;
  // As sent with the pose, else from the last two poses. Not known, and zero, after the first, and
  // after a gap longer than twice the age limit: over that a difference says nothing about now.
  Twist twist;
  bool twist_known = false;
  Motion motion;  // since the last tick; none when first seen
  // Of a link whose pose follows from joints: they say how late it is, and how far it may have
  // moved since, m.
  bool follows_joints = false, joints_late = false, joints_contradicted = false;
  double unseen_by_joints = 0.0;
  Landmarks landmarks;
  Anchor anchor;
  Repetition repetition;
  Reckoning reckoning;
  OtherPlace other_place;

  Pose pose_last_tick;
  Pose pose_before;  // while it has moved: the one in use at the last tick; after `first_seen`, now
  bool seen_last_tick = false;

  // Whether anything can be said about where it is now.
  [[nodiscard]] bool known() const noexcept {
    return input.has_value && may_have_moved < kInfinity;
  }
  // Whether `twist` is how it moves now: a late object may do anything since its stamp.
  [[nodiscard]] bool velocity_known() const noexcept { return twist_known && !input.late; }

  // Since the last tick, where it was known then: as seen from another, and the way it is taken to
  // have gone.
  [[nodiscard]] BodyMotion body_motion() const noexcept {
    return {.before = pose_before, .now = pose, .motion = motion, .reach = reach};
  }
  [[nodiscard]] InterpolatedMotion interpolated() const noexcept {
    return interpolated_motion(moved ? pose_before : pose, pose);
  }

  // As `displacement`, since the last tick or since something has been known of it, m.
  [[nodiscard]] double known_displacement() const noexcept {
    return first_seen ? 0.0 : displacement;
  }
};

// Before any input: a fixed object stands where the scene says.
[[nodiscard]] TrackedObject initial_state(const Object& object);

// Takes a sample into use; else says why it must not be used, and notes what that says of the
// object. `object` is a moving one and the one that the sample names; `stamp_ns` is the sample's,
// in the tick's time.
[[nodiscard]] std::optional<Reject> take(const Object& object, const PoseSample& sample,
                                         std::int64_t stamp_ns, const SampleLimits& limits,
                                         TrackedObject& state) noexcept;

// A link of a robot is where its joints say. One that is not known now, but was, may be anywhere;
// so may one whose pose rounding puts farther off than Object::pose_error says.
void follow(const LinkState& link, const Object& object, TrackedObject& state) noexcept;

// The age of the pose in use is not known any more: it is late until the next one comes.
void forget_age(std::int64_t now_ns, TrackedObject& state) noexcept;

// Ends the tick's input: motion since the last tick, age and lateness.
void advance(const Object& object, std::int64_t now_ns, TrackedObject& state) noexcept;

// Counts this tick's motion in; no point of the object is farther than `reach` from its origin.
void displace(double reach, TrackedObject& state) noexcept;

}  // namespace clearance
