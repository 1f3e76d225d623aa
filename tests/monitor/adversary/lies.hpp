// Faults of inputs: what is told instead of the truth, by whom, from when to when, and how soon a
// monitor can notice it.
//
// Some lies cannot be told from the truth by anyone who hears only them. They are left out:
// - One source alone lies smoothly within the stated speeds and limits, and its velocities agree.
//   So does one that is a constant time late, or that is off by a constant from the start.
// - Positions stop or slow down, and neither a velocity nor a frozen limit contradicts them. So do
//   frames of tf, which have no velocities. The frozen limit of an object that follows a frame does
//   not, either: its pose in the world changes with the frames above.
// - Positions and velocities contradict each other, and then agree for 51 age limits: positions are
//   believed where they are.
// - A source falls silent, and another one claims what the object can have reached meanwhile.
// - A source leaps, and stays there until the object can have got there.
// - An object comes back from its absence in the middle of a lie, which is then the first that is
//   heard of it.
// - A value is wrong by less than the object moves within its age limit. The cell accepts that as
//   an error of timing.
// - The points of a camera are false and move as points may. A program that publishes them first,
//   or takes them over from one that is silent, is believed.
// - A cloud of one row loses points: only rows of a picture say how many there have to be.
// - A map stands still under fresh stamps: so does one of a place where nothing changes.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/monitor/adversary/lying_cell.hpp"
#include "tests/monitor/adversary/true_motion.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test::lies {

enum class Lie : std::uint8_t {
  kFreezeInMotion,     // the value stays, with fresh stamps and true velocities
  kFreezeAtRest,       // the value stays, with velocities of zero or without any
  kLeap,               // metres or radians away, and back
  kDrift,              // away at 2.5 times the stated speed
  kHalfSpeed,          // half of the true speed, with true velocities
  kZeroVelocities,     // true values
  kWrongSign,          // velocities of the wrong sign with true values
  kWrongUnit,          // velocities in degrees with true values
  kWrongStamps,        // ahead or behind
  kSilence,            //
  kReordered,          // messages arrive up to 30 ms late and in any order
  kDuplicated,         // each message arrives several times, at once and later
  kRivalLater,         // a second source tells other values
  kRivalFirst,         // another source was there before: zeros, or a latched tf_static
  kRivalWhileRefused,  // the owner leaps, and a rival tells smoothly what is false, too
  kTakeover,           // the owner is silent, and a rival says what cannot have been reached
  kOutOfLimits,        // a joint beyond its limits, from the start
  kWrapped,            // no lie: a continuous joint within plus or minus pi
  kParentFar,          // a frame hangs on another parent, or points are in that frame, 50 m away
  kWrongQuaternion,    // not of unit length, or half a turn away
  kNotANumber,         //
  kScaled,             // lengths in mm, angles in degrees
  kTorn,               // all points but one are missing
  kLayout,             // fields of points that share bytes, or rows that are half padding
  kRing,               // twelve pictures in turn, with fresh stamps
  kHeld,               // a network holds all messages back, and delivers them at the end
  kMiscounted,         // a joint twice with two values, or too few values for a robot's links
  kAttached,           // no lie: a command attaches the part to the arm, another one detaches it
  kAbsent,             // no lie: commands take a ball away and bring it back
  kUnwatched,          // no lie: commands leave a pair out and watch it again
  kAllowed,            // no lie: commands allow a contact and withdraw it
  kRestored,           // no lie: a partner goes on from the saved state, and its reports count
  kCount
};
inline constexpr auto kLies = static_cast<std::size_t>(Lie::kCount);
[[nodiscard]] const char* name(Lie lie);

struct Fault {
  Lie lie = Lie::kSilence;
  Channel channel = Channel::kBall0;
  std::int64_t from = 0, to = 0;  // ns since the start; `to` is not included
  double size = 0.0;              // of the lie: m, rad, ns; by its kind
  Vec3 direction = Vec3::UnitX();
  std::size_t joint = 0;
  bool flag = false;  // chooses between two forms
};
[[nodiscard]] std::string described(const Fault& fault);

// True if the fault can strike that channel at all.
[[nodiscard]] bool strikes(Lie lie, Channel channel);
[[nodiscard]] Fault drawn(Lie lie, Channel channel, Random& random);
// Up to three faults of different channels. The first kind is `seed` modulo the number of kinds.
[[nodiscard]] std::vector<Fault> drawn_mix(std::uint64_t seed);

// The delay until a lie can be noticed, and the error of a value that cannot be noticed.
struct Admissible {
  std::int64_t delay = 0;  // ns from its beginning, during which nothing is judged
  // In units of (stated speed x age limit), from its beginning until kSlackEnds after its end.
  double slack = 0.0;
};
[[nodiscard]] Admissible admissible(const Fault& fault);
// A value within the slack may be in use at the end of a lie. The next true one replaces it.
inline constexpr std::int64_t kSlackEnds = 100 * kMs;
// Until it is in force, a command changes nothing, and the successor may wait so many ticks until
// all its pairs are certified (Successor::kMostUncertified).
inline constexpr std::int64_t kCommandTakes = 300 * kMs;
// The owner of a RivalFirst begins then; before, only the lie is heard.
inline constexpr std::int64_t kOwnerStarts = 300 * kMs;
// The time from the beginning and from the end of a lie during which speeds may be false.
// Velocities are compared with positions over 10 age limits, and then anew. With the speed u and
// the stated speed v, a wrong sign shows after (v/8u + 2) / (2 - 1/6) age limits, and after 5/6
// more where the path before was true: 3 at most from u = v/14 on. The comparison may end before,
// and the joint turn back in the middle of the next one, which then shows nothing: 3 + 10 + 3.
// Zeros show sooner: (v/8u + 2 + 10/6), or v/8u in a comparison that begins with them. At half the
// speed, positions that lag behind a joint that turned back move against its velocities. That
// cannot be told from a wrong sign: their differences count as the speed while the lie lasts.
[[nodiscard]] std::int64_t speed_delay(const Fault& fault);

// Pairs have to be certified again this long after the end of a lie. A hold after a contradiction
// of velocities takes 51 age limits, which is a second, and a source that was there first is given
// up after one. A ball is then unknown until it can have got, at the stated speed, from the rival's
// last pose to that of its owner, and for an age limit more. The two poses are apart by the rival's
// offset and the true motion meanwhile, which is at most twice kBallReach.
// The coordinates of a base are judged one by one. A leap that is refused may be short in one of
// them, which the base can have reached at the end of the lie. It can be back after the same time,
// and longer by the true motion until then and since: four times kBaseReach.
[[nodiscard]] std::int64_t recovers(const Fault& fault);

// The changes that the owner of a channel makes to the truth at an instant.
struct Told {
  std::int64_t value_at = 0;  // the instant of the told value
  Vec3 offset = Vec3::Zero();
  std::array<double, kJoints> joint_offset{};
  double length_scale = 1.0, angle_scale = 1.0;
  double velocity_scale = 1.0;
  std::optional<bool> velocities = {};  // sent or not; nothing: as the channel does otherwise
  bool is_nan = false, is_far = false, is_silent = false, is_wrapped = false;
  double quaternion_scale = 1.0;
  bool is_turned = false;          // by half a turn about z
  std::int64_t stamp_offset = 0;   // ns
  std::int64_t longest_delay = 0;  // ns
  bool is_repeated = false;
  bool is_torn = false, has_other_layout = false, is_padded = false;  // of what is seen
  bool goes_on_a_little = false;                                      // one pixel of a picture
  std::int64_t held_until = 0;
  bool has_joint_twice = false, has_too_few = false;
};
[[nodiscard]] Told told(const Fault& fault, std::int64_t t);

// The message of a rival, if there is one.
struct Rival {
  bool is_matched = false;  // its writer exists
  bool speaks = false;
  std::int64_t value_at = 0;
  Vec3 offset = Vec3::Zero();
  std::array<double, kJoints> joint_offset{};
  bool is_zero = false;  // joints at zero
  // Only the first joint is told: the others can be where they were.
  bool is_of_one_joint = false;
  bool is_static = false;  // a frame on tf_static
};
[[nodiscard]] Rival rival(const Fault& fault, std::int64_t t);

}  // namespace clearance::test::lies
