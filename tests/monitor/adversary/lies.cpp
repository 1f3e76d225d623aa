#include "tests/monitor/adversary/lies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace clearance::test::lies {
namespace {

constexpr std::int64_t kTakeoverFrom = 1050 * kMs;  // after the owner fell silent
constexpr double kOutOfReach = 8.0;                 // m, of a takeover

std::int64_t age_limit(Channel channel) {
  if (channel == Channel::kEye || is_seen(channel)) return kEyeAgeLimit;
  return channel == Channel::kOdom || channel == Channel::kBase ? kBaseAgeLimit : kAgeLimit;
}

// How long a picture that this channel has placed is in use: late, it is unknown (config/KEYS.md).
std::int64_t old_picture(Channel channel) { return channel == Channel::kEye ? kEyeAgeLimit : 0; }

double stated_speed(Channel channel) {
  if (channel == Channel::kEye) return kEyeSpeed;
  return channel == Channel::kOdom || channel == Channel::kBase ? kBaseSpeed : kBallSpeed;
}

bool has_velocities(Channel channel) { return is_ball(channel) || is_robot(channel); }

double since(const Fault& fault, std::int64_t t) {
  return 1e-9 * static_cast<double>(t - fault.from);
}

struct Span {
  double shortest, longest;  // ms
};

// A leap may not last until the object can have got there, and half a speed not until positions
// that are contradicted may be believed again: 3 (v/u + 1) age limits after it began at the
// earliest, with the true speed u below the stated v, and 51 more.
Span duration_of(const Fault& fault) {
  switch (fault.lie) {
    case Lie::kLeap:
      return {1.0, is_robot(fault.channel) ? 400.0 : 700.0};
    case Lie::kScaled:
    case Lie::kParentFar:
      return {1.0, 600.0};
    case Lie::kHalfSpeed:
      return {200.0, 1e-6 * static_cast<double>((6 + 51) * age_limit(fault.channel))};
    case Lie::kRivalWhileRefused:
      return {1500.0, 1700.0};
    case Lie::kTakeover:
      return {1300.0, 1500.0};
    case Lie::kDrift:
      return {300.0, 1000.0};
    case Lie::kWrongQuaternion:
      return {1.0, fault.flag ? 100.0 : 1000.0};
    case Lie::kNotANumber:
      return {1.0, 1000.0};
    default:
      return {200.0, 2000.0};
  }
}

// Lengths in m and angles in rad; times in ns.
double size_of(const Fault& fault, Random& random) {
  switch (fault.lie) {
    case Lie::kLeap:
      if (is_robot(fault.channel)) return random.sign() * random.uniform(1.5, 2.0);
      return random.uniform(3.0, 7.0);
    case Lie::kWrongStamps:
      // How old the points are that come with fresh stamps.
      if (is_seen(fault.channel)) return static_cast<double>(kMs) * random.integer(5, 99);
      return static_cast<double>(kMs) *
             (fault.flag ? random.uniform(1.0, 4.0) : -random.uniform(5.0, 200.0));
    case Lie::kRivalLater:
    case Lie::kRivalFirst:
      return random.uniform(1.0, 2.5);
    case Lie::kRivalWhileRefused:
      return random.uniform(0.8, 1.5);
    case Lie::kTakeover:
      return is_robot(fault.channel) ? random.sign() * 2.6 : kOutOfReach;
    case Lie::kOutOfLimits:
      return fault.joint == 3 ? random.uniform(0.6, 1.0) : random.sign() * random.uniform(4.0, 6.0);
    default:
      return 0.0;
  }
}

std::size_t joint_of(Lie lie, Random& random) {
  if (lie == Lie::kOutOfLimits) return std::array{0u, 1u, 3u}[random.next() % 3];
  if (lie == Lie::kTakeover) return 0;
  if (lie == Lie::kLeap) return random.next() % 3;
  return random.next() % kJoints;
}

// Moves what is told away from the truth, at 2.5 times the stated speed.
void drift(const Fault& fault, std::int64_t t, Told& told) {
  const double lengths = 2.5 * since(fault, t);
  // What rests on odom is held against a limit of its own.
  const double stated = fault.channel == Channel::kOdom ? kBallSpeed : stated_speed(fault.channel);
  told.offset = lengths * stated * fault.direction;
  told.joint_offset[fault.joint] = lengths * kJointSpeed[fault.joint] * (fault.flag ? 1 : -1);
}

bool strikes_seen(Lie lie, Channel channel) {
  constexpr std::array kAll{
      Lie::kFreezeAtRest, Lie::kWrongStamps, Lie::kSilence,    Lie::kReordered, Lie::kDuplicated,
      Lie::kRivalLater,   Lie::kParentFar,   Lie::kNotANumber, Lie::kScaled,    Lie::kTorn,
      Lie::kLayout,       Lie::kRing,        Lie::kHeld};
  const bool is_still = lie == Lie::kFreezeAtRest || lie == Lie::kRing;
  return std::ranges::count(kAll, lie) != 0 && !(is_still && channel == Channel::kMap);
}

// Makes the lies that only cameras and maps tell, or that they tell differently.
bool is_told_of_seen(const Fault& fault, std::int64_t t, Told& told) {
  if (!is_seen(fault.channel)) return false;
  if (fault.lie == Lie::kRing)
    told.value_at = fault.from + (t - fault.from) % (12 * kPicturePeriod);
  told.goes_on_a_little = fault.lie == Lie::kFreezeAtRest && fault.flag;
  if (fault.lie == Lie::kWrongStamps) told.value_at -= static_cast<std::int64_t>(fault.size);
  told.is_torn = fault.lie == Lie::kTorn;
  told.has_other_layout = fault.lie == Lie::kLayout && !fault.flag;
  told.is_padded = fault.lie == Lie::kLayout && fault.flag;
  constexpr std::array kAll{Lie::kWrongStamps, Lie::kTorn, Lie::kLayout, Lie::kRing};
  return std::ranges::count(kAll, fault.lie) != 0;
}

// The ball that commands take away comes back, from the end of their fault until they have to be in
// force, in the middle of a lie: what is heard then is the first that is heard of it.
bool is_unheard(const std::vector<Fault>& mix) {
  const auto returns = std::ranges::find(mix, Lie::kAbsent, &Fault::lie);
  return returns != mix.end() && std::ranges::any_of(mix, [&](const Fault& fault) {
           return fault.channel == Channel::kBall2 && fault.to > returns->to &&
                  fault.from <= returns->to + kCommandTakes;
         });
}

}  // namespace

const char* name(Lie lie) {
  constexpr std::array<const char*, kLies> kNames{
      "FreezeInMotion", "FreezeAtRest", "Leap",       "Drift",       "HalfSpeed",
      "ZeroVelocities", "WrongSign",    "WrongUnit",  "WrongStamps", "Silence",
      "Reordered",      "Duplicated",   "RivalLater", "RivalFirst",  "RivalWhileRefused",
      "Takeover",       "OutOfLimits",  "Wrapped",    "ParentFar",   "WrongQuaternion",
      "NotANumber",     "Scaled",       "Torn",       "Layout",      "Ring",
      "Held",           "Miscounted",   "Attached",   "Absent",      "Unwatched",
      "Allowed",        "Restored"};
  return kNames[static_cast<std::size_t>(lie)];
}

std::string described(const Fault& fault) {
  return fmt::format("{} of {} from {} to {} ms, size {:.4g}{}{}", name(fault.lie),
                     name(fault.channel), fault.from / kMs, fault.to / kMs, fault.size,
                     is_robot(fault.channel) ? std::string(", ") + kJointNames[fault.joint] : "",
                     fault.flag ? ", second form" : "");
}

bool strikes(Lie lie, Channel channel) {
  if (is_seen(channel)) return strikes_seen(lie, channel);
  if (lie == Lie::kRestored) return channel == Channel::kPartner;
  if (lie >= Lie::kAttached || !is_sent(channel))
    return lie >= Lie::kAttached && channel == Channel::kCommands;
  switch (lie) {
    case Lie::kFreezeInMotion:
    case Lie::kHalfSpeed:
    case Lie::kZeroVelocities:
    case Lie::kWrongSign:
    case Lie::kWrongUnit:
      return has_velocities(channel);
    case Lie::kFreezeAtRest:
      if (is_robot(channel)) return *kJointFrozenKey != '\0';
      return is_ball(channel);
    case Lie::kOutOfLimits:
    case Lie::kWrapped:
    case Lie::kMiscounted:
      return is_robot(channel);
    case Lie::kParentFar:
      return is_frame(channel);
    case Lie::kTorn:
    case Lie::kLayout:
    case Lie::kRing:
      return false;
    case Lie::kWrongQuaternion:
      return !is_robot(channel);
    default:
      return true;
  }
}

Fault drawn(Lie lie, Channel channel, Random& random) {
  Fault fault{.lie = lie, .channel = channel};
  fault.flag = random.chance(0.5);
  fault.joint = joint_of(lie, random);
  fault.direction = random.direction();
  fault.size = size_of(fault, random);
  const Span span = duration_of(fault);
  fault.from = static_cast<std::int64_t>(random.uniform(1000.0, 1500.0)) * kMs;
  fault.to =
      fault.from + static_cast<std::int64_t>(random.uniform(span.shortest, span.longest)) * kMs;
  if (lie == Lie::kRivalFirst || lie == Lie::kOutOfLimits) {
    fault.from = 0;
    fault.to = static_cast<std::int64_t>(random.uniform(1800.0, 2500.0)) * kMs;
  }
  // The picture that is repeated is the first one of the fault, and true.
  if (is_seen(channel)) fault.from -= fault.from % kPicturePeriod;
  return fault;
}

std::vector<Fault> drawn_mix(std::uint64_t seed) {
  Random random(seed);
  std::vector<Fault> mix;
  const int count = random.integer(1, 3);
  while (static_cast<int>(mix.size()) < count) {
    const auto lie = static_cast<Lie>(mix.empty() ? seed % kLies : random.next() % kLies);
    const auto channel = static_cast<Channel>(random.next() % kChannels);
    const bool is_free =
        std::ranges::none_of(mix, [&](const Fault& fault) { return fault.channel == channel; });
    if (!is_free || !strikes(lie, channel)) continue;
    mix.push_back(drawn(lie, channel, random));
    if (is_unheard(mix)) mix.pop_back();
  }
  return mix;
}

std::int64_t speed_delay(const Fault& fault) {
  const std::int64_t delay = 16 * age_limit(fault.channel);
  return fault.lie == Lie::kHalfSpeed ? std::max(delay, fault.to - fault.from) : delay;
}

Admissible admissible(const Fault& fault) {
  switch (fault.lie) {
    // A velocity may be wrong by a sixth, over at most 50 age limits. With the true speed u below
    // the stated v, the values contradict it after (v + u) age limits and a sixth of the path.
    case Lie::kFreezeInMotion:
    case Lie::kHalfSpeed:
      return {0, 10.5};
    // The frozen limit is the time that the cell grants, from the first repeated sample on, which
    // may come a period of 2 ms after the fault. The next sample after the limit shows that it has
    // passed, and takes up to 5 ms.
    // A picture that repeats is noticed at once.
    case Lie::kFreezeAtRest:
      return {is_seen(fault.channel) ? 0 : kFrozenLimit + 10 * kMs, 0.0};
    // Positions are compared with one that is up to six age limits old, with one in hand. A picture
    // that was placed by the lie stays in use until it is old.
    case Lie::kDrift:
      return {7 * age_limit(fault.channel) + old_picture(fault.channel), 1.0};
    // What is seen is of a time before the stamp: meanwhile it has moved, or the camera has, by
    // less than the age limit allows.
    case Lie::kWrongStamps:
      if (is_seen(fault.channel)) return {0, fault.size / static_cast<double>(kEyeAgeLimit)};
      // Stamps ahead by less than the cell's limit for the future claim an age of zero.
      return {0, fault.size > 0.0 ? 1.0 : 0.0};
    // Where an angle passes through zero, it is right in any unit.
    case Lie::kScaled:
      return {0, is_robot(fault.channel) ? 1.0 : 0.0};
    // Only the lie is heard, until the owner speaks for the first time and its message has come. A
    // picture that was placed by the lie stays in use until it is old.
    case Lie::kRivalFirst:
      return {kOwnerStarts + 5 * kMs + old_picture(fault.channel), 0.0};
    // All others can be noticed in the tick that hears them.
    default:
      return {};
  }
}

std::int64_t recovers(const Fault& fault) {
  constexpr std::int64_t kUsual = 2 * kSecond;
  const bool is_base = fault.channel == Channel::kOdom || fault.channel == Channel::kBase;
  if (fault.lie == Lie::kRivalFirst && is_ball(fault.channel)) {
    const double farthest = fault.size + 2.0 * TrueMotion::kBallReach;
    return std::max<std::int64_t>(kUsual, kAgeLimit + std::llround(1e9 * farthest / kBallSpeed));
  }
  if (fault.lie == Lie::kRivalWhileRefused && is_base) {
    const double moved = 4.0 * TrueMotion::kBaseReach;
    return std::max<std::int64_t>(kUsual,
                                  fault.to - fault.from + std::llround(1e9 * moved / kBaseSpeed));
  }
  return kUsual;
}

Told told(const Fault& fault, std::int64_t t) {
  Told told{.value_at = t};
  if (fault.lie == Lie::kRivalFirst) told.is_silent = t < kOwnerStarts;
  // A velocity that is contradicted has to be sent before, too.
  constexpr std::array kOfVelocities{Lie::kFreezeInMotion, Lie::kHalfSpeed, Lie::kZeroVelocities,
                                     Lie::kWrongSign, Lie::kWrongUnit};
  if (std::ranges::count(kOfVelocities, fault.lie) != 0) told.velocities = true;
  if (t < fault.from || t >= fault.to || is_told_of_seen(fault, t, told)) return told;
  told.is_repeated = fault.lie == Lie::kDuplicated;
  if (fault.lie == Lie::kHeld) told.held_until = fault.to;
  switch (fault.lie) {
    case Lie::kFreezeInMotion:
      told.value_at = fault.from;
      break;
    case Lie::kFreezeAtRest:
      told.value_at = fault.from;
      told.velocity_scale = 0.0;
      told.velocities = fault.flag;
      break;
    case Lie::kLeap:
    case Lie::kRivalWhileRefused:
      if (fault.lie == Lie::kLeap || !is_robot(fault.channel)) {
        told.offset = (fault.lie == Lie::kLeap ? fault.size : kOutOfReach) * fault.direction;
        told.joint_offset[fault.joint] = fault.size;
      } else {
        told.joint_offset[0] = 5.0;
      }
      break;
    case Lie::kDrift:
      drift(fault, t, told);
      break;
    case Lie::kHalfSpeed:
      told.value_at = fault.from + (t - fault.from) / 2;
      break;
    case Lie::kZeroVelocities:
    case Lie::kWrongSign:
    case Lie::kWrongUnit:
      told.velocity_scale = fault.lie == Lie::kZeroVelocities ? 0.0
                            : fault.lie == Lie::kWrongSign    ? -1.0
                                                              : 57.29577951308232;
      break;
    case Lie::kWrongStamps:
      told.stamp_offset = static_cast<std::int64_t>(fault.size);
      break;
    case Lie::kSilence:
    case Lie::kTakeover:
      told.is_silent = true;
      break;
    case Lie::kReordered:
      told.longest_delay = 30 * kMs;
      break;
    case Lie::kMiscounted:
      (fault.flag ? told.has_joint_twice : told.has_too_few) = true;
      break;
    case Lie::kOutOfLimits:
      told.joint_offset[fault.joint] = fault.size;
      break;
    case Lie::kWrapped:
      told.is_wrapped = true;
      break;
    case Lie::kParentFar:
      told.is_far = true;
      break;
    case Lie::kWrongQuaternion:
      told.is_turned = fault.flag;
      told.quaternion_scale = fault.flag ? 1.0 : 1.5;
      break;
    case Lie::kNotANumber:
      told.is_nan = true;
      break;
    case Lie::kScaled:
      told.length_scale = 1000.0;
      told.angle_scale = 57.29577951308232;
      break;
    default:
      break;
  }
  return told;
}

Rival rival(const Fault& fault, std::int64_t t) {
  Rival rival{.value_at = t};
  if (t < fault.from || t >= fault.to) return rival;
  switch (fault.lie) {
    case Lie::kRivalLater:
      rival.is_matched = rival.speaks = true;
      break;
    case Lie::kRivalFirst:
      rival.is_matched = true;
      rival.is_zero = is_robot(fault.channel);
      rival.is_static = is_frame(fault.channel);
      // A latched transform comes once.
      rival.speaks = !rival.is_static || t < fault.from + kMs;
      break;
    case Lie::kRivalWhileRefused:
      rival.is_matched = rival.speaks = t >= fault.from + 100 * kMs;
      break;
    case Lie::kTakeover:
      rival.is_matched = rival.speaks = t >= fault.from + kTakeoverFrom;
      rival.value_at = fault.from;
      rival.is_of_one_joint = true;
      break;
    default:
      return rival;
  }
  rival.offset = fault.size * fault.direction;
  rival.joint_offset[is_robot(fault.channel) ? 0 : fault.joint] = fault.size;
  return rival;
}

}  // namespace clearance::test::lies
