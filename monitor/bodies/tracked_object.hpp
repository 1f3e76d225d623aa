// One object of the scene: the pose in use, its source and its motion.
#pragma once

#include <cstdint>
#include <optional>

#include "config/scene/scene.hpp"
#include "monitor/bodies/displacement.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/interpolated_motion.hpp"
#include "monitor/bodies/landmarks.hpp"
#include "monitor/bodies/relative_displacement.hpp"
#include "monitor/inputs/input_record.hpp"
#include "monitor/inputs/plausibility.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// While an object repeats its pose, and its twist is zero, nothing changes but the stamp. Until a
// check is due again, such samples are taken without it.
struct Rest {
  bool holds = false;         // the last sample was of this kind
  bool has_twist = false;     // that sample had a twist
  std::int64_t until_ns = 0;  // stamp of the last sample that needs no check
};

struct alignas(64) TrackedObject {
  // The members up to `accumulated_turn` fill one cache line. Every pair reads them from both its
  // objects in each tick.
  bool moved = false;          // the pose differs from that of the last tick
  bool newly_known = false;    // nothing was known of it at the last tick
  bool discontinuous = false;  // it was known, but its pose jumped farther than anything moves
  // No special case applies: known and on time now and at the last tick, and no discontinuity in
  // between.
  bool plain = false;
  bool absent = false;  // known not to be there (presence.hpp); then no pose is in use
  // Bound of the motion since its stamp, m. It is 0 unless late, and infinity if no speed is
  // stated. What a sensor sees may also have moved before it is late, if a speed is stated.
  double may_have_moved = 0.0;
  double unobserved = 0.0;  // may_have_moved, or that of the last tick if larger and known, m
  // Bounds of the displacement of any point, m, set by displace(). `displacement` is that since the
  // last tick; infinity: not known. The accumulated ones are the totals up to the last tick and up
  // to now. They leave out the ticks whose displacement is not known.
  double displacement = 0.0, accumulated_last_tick = 0.0, accumulated = 0.0;
  // Compares the motion with a straight one at constant velocity from the last tick's pose to this
  // one. At no instant since the last tick was any point farther than this from that motion, m.
  double bend = 0.0;
  double accumulated_turn = 0.0;  // accumulated Motion::turn

  // The reports of its pairs read the members from here to `twist_known`. A sample of an object at
  // rest reads and writes two lines of memory: the pose, and the rest with the first of `input`.
  double bounding_radius = kInfinity;  // around its origin, m; set by displace()
  // The pose in use, as sent. It is normalised if the orientation is off unit length by more than
  // 5e-7.
  Pose pose;
  Rest rest;
  InputRecord input;  // of its poses; for a link that follows joints, of the joints
  // The twist sent with the pose, else the mean velocity between the last two poses. It is zero and
  // not known after the first pose, and after a gap longer than twice the age limit. Over such a
  // gap a mean says nothing about the present.
  Twist twist;
  Motion motion;  // since the last tick; zero if nothing was known then
  bool twist_known = false;
  // For a link that follows joints, the joints determine its lateness and its unobserved motion, m.
  bool follows_joints = false, joints_late = false, joints_contradicted = false;
  double unobserved_by_joints = 0.0;
  Landmarks landmarks;
  Repetition repetition;
  Plausibility<Landmarks> plausibility;

  Pose pose_last_tick;
  Pose pose_before;  // if moved: the pose of the last tick; after `newly_known`: `pose`
  bool pose_last_tick_known = false;

  // True if only a sample, a time at which it becomes late, or its joints can change this state: a
  // tick that does not visit it leaves it as a visit would.
  [[nodiscard]] bool at_rest() const noexcept {
    if (follows_joints) return false;
    return !input.has_value || (plain && !moved && accumulated_last_tick == accumulated);
  }
  // `own`: before anything was heard. What follows from the body alone is not compared.
  [[nodiscard]] bool is_sound(const TrackedObject& own) const noexcept;
  // True if there is a bound on where it is now.
  [[nodiscard]] bool known() const noexcept {
    return input.has_value && may_have_moved < kInfinity;
  }
  // True if that bound is believed: nothing contradicts its poses or joints.
  [[nodiscard]] bool is_trusted() const noexcept { return known() && !input.contradicted; }
  // True if `twist` is its present velocity. A late object may have moved arbitrarily since its
  // stamp.
  [[nodiscard]] bool velocity_known() const noexcept { return twist_known && !input.late; }

  // The motion since the last tick, if the object was known then. Relative displacements use
  // body_motion(). The assumed motion between the two poses is interpolated().
  [[nodiscard]] BodyMotion body_motion() const noexcept {
    return {
        .before = pose_before, .now = pose, .motion = motion, .bounding_radius = bounding_radius};
  }
  [[nodiscard]] InterpolatedMotion interpolated() const noexcept {
    return interpolated_motion(moved ? pose_before : pose, pose);
  }

  // Returns `displacement`, but 0 if the object was not known at the last tick, m.
  [[nodiscard]] double known_displacement() const noexcept {
    return newly_known ? 0.0 : displacement;
  }
};

// True if no coordinate is beyond kLargestCoordinate and the quaternion is of unit length.
[[nodiscard]] bool is_usable(const Pose& pose) noexcept;

// The state before any input: a fixed object is at its pose in the scene.
[[nodiscard]] TrackedObject initial_state(const Object& object);

// Takes a sample into use, or returns why it must not be used and updates the contradiction state.
// `object` must be moving and the one that the sample names. `stamp_ns` is the sample's stamp in
// the tick's time.
[[nodiscard]] std::optional<Reject> take(const Object& object, const PoseSample& sample,
                                         std::int64_t stamp_ns, const SampleLimits& limits,
                                         TrackedObject& state) noexcept;

// Takes a sample of an object at rest, or returns false if the sample needs the checks of take().
// It then has changed nothing.
[[nodiscard]] bool take_at_rest(std::int64_t age_limit_ns, const PoseSample& sample,
                                std::int64_t stamp_ns, const SampleLimits& limits,
                                TrackedObject& state) noexcept;

// Takes the pose of a sensor at a new frame, whose content replaces the former one: nothing from
// before is used. Returns why the frame must not be used, and then changes nothing.
[[nodiscard]] std::optional<Reject> see(const Pose& world_from_sensor, std::int64_t stamp_ns,
                                        const SampleLimits& limits, TrackedObject& state) noexcept;

// True if what a sensor has seen may be anywhere in the ball of its view by this time: its frame is
// late, and the object's largest speed leads that far. Without such a speed, it always does.
[[nodiscard]] bool may_be_anywhere(const Object& object, std::int64_t now_ns,
                                   const TrackedObject& state) noexcept;

// Takes the state of a robot's link from its joints, or from what carries it. A link that was known
// and no longer is may be anywhere. The same applies if the rounding error of its pose exceeds
// Object::pose_error. An object that states max_speed follows the pose of another object, without
// joints in between: it is then within max_speed times the age of that pose.
void follow(const LinkState& link, const Object& object, std::int64_t now_ns, TrackedObject& state,
            std::int64_t response_left_ns = kAnyAge) noexcept;

// The age of the pose in use is not known any more: it is late until the next one comes.
void forget_age(std::int64_t now_ns, TrackedObject& state) noexcept;

// The trust in the place of a pose in use. For a sensor, its carrier decides that.
enum class Trust : std::uint8_t {
  kAlways,
  kWhileOnTime,  // once the pose is late, the object may be anywhere
  kNever,        // which counts as a contradiction
};

// Ends the tick's input: sets the motion since the last tick, the age and the lateness. An object
// whose pose is older than `response_left_ns` may be anywhere.
void advance(const Object& object, std::int64_t now_ns, TrackedObject& state,
             Trust trust = Trust::kAlways, std::int64_t response_left_ns = kAnyAge) noexcept;

// Accumulates this tick's motion. `bounding_radius` is that of the object around its
// origin, m.
void displace(double bounding_radius, TrackedObject& state) noexcept;

}  // namespace clearance
