#include "monitor/bodies/tracked_object.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t kEarliest = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t kLatest = std::numeric_limits<std::int64_t>::max();
constexpr std::int64_t kFutureLimit = 5 * kTick;

PoseSample good() { return test::sample(0, test::at(1, 2, 3), kStart); }

Object late_after(std::int64_t limit_ns, double max_speed) {
  Object object = test::moving("object", {});
  object.age_limit_ns = limit_ns;
  object.max_speed = max_speed;
  return object;
}

const Object kInTime = late_after(20 * kTick, kInfinity);

// Judges the sample, whose stamps are in the tick's time.
std::optional<Reject> judged(const PoseSample& sample, const Object& object, TrackedObject& state,
                             std::int64_t now_ns = kStart) {
  return take(object, sample, sample.stamp_ns, {now_ns, kFutureLimit}, state);
}
std::optional<Reject> judged(const PoseSample& sample, std::int64_t now_ns = kStart) {
  TrackedObject state;
  return judged(sample, kInTime, state, now_ns);
}
void take(const PoseSample& sample, TrackedObject& state) {
  ASSERT_EQ(judged(sample, kInTime, state, sample.stamp_ns), std::nullopt);
}

TEST(TrackedObject, AcceptsAPlainSample) { EXPECT_EQ(judged(good()), std::nullopt); }

TEST(TrackedObject, RefusesEveryNonFiniteFigure) {
  for (const double bad : {kNoNumber, kInfinity, -kInfinity, 2e9}) {
    for (int i = 0; i < 3; ++i) {
      PoseSample sample = good();
      sample.world_from_object.position[i] = bad;
      EXPECT_EQ(judged(sample), Reject::kNonFinite);
      sample = good();
      sample.has_twist = true;
      sample.twist.linear[i] = bad;
      EXPECT_EQ(judged(sample), Reject::kNonFinite);
      sample.twist = {};
      sample.twist.angular[i] = bad;
      EXPECT_EQ(judged(sample), Reject::kNonFinite);
      sample.has_twist = false;  // the twist is then not read
      EXPECT_EQ(judged(sample), std::nullopt);
    }
  }
  for (int i = 0; i < 4; ++i) {
    PoseSample sample = good();
    sample.world_from_object.orientation.coeffs()[i] = kNoNumber;
    EXPECT_EQ(judged(sample), Reject::kNonFinite);
  }
}

TEST(TrackedObject, RefusesAQuaternionFarFromUnitLength) {
  for (const double norm : {0.0, 0.5, 0.998, 1.002, 2.0, 1e300}) {
    PoseSample sample = good();
    sample.world_from_object.orientation.coeffs() *= norm;
    EXPECT_EQ(judged(sample), Reject::kNotUnit) << norm;
  }
  for (const double norm : {0.9991, 1.0009, -1.0}) {
    PoseSample sample = good();
    sample.world_from_object.orientation.coeffs() *= norm;
    EXPECT_EQ(judged(sample), std::nullopt) << norm;
  }
}

TEST(TrackedObject, RefusesAStampFartherAheadThanTheLimit) {
  PoseSample sample = good();
  sample.stamp_ns = kStart + kFutureLimit;
  EXPECT_EQ(judged(sample), std::nullopt);
  sample.stamp_ns += 1;
  EXPECT_EQ(judged(sample), Reject::kFuture);
  sample.stamp_ns = kLatest;
  EXPECT_EQ(judged(sample, kEarliest), Reject::kFuture);
}

TEST(TrackedObject, RefusesTimeGoingBackwardsButNotStandingStill) {
  TrackedObject state;
  take(good(), state);
  PoseSample sample = good();
  EXPECT_EQ(judged(sample, kInTime, state), std::nullopt);
  sample.stamp_ns -= 1;
  EXPECT_EQ(judged(sample, kInTime, state), Reject::kBackwards);
}

TEST(TrackedObject, TwistIsThatOfTheLastTwoPosesUnlessGiven) {
  TrackedObject state;
  take(good(), state);
  EXPECT_FALSE(state.velocity_known());

  PoseSample next = good();
  next.stamp_ns += 4 * kTick;
  next.world_from_object.position += Vec3(0.004, 0, 0);
  next.world_from_object.orientation = Eigen::AngleAxisd(0.002, Vec3::UnitY());
  // the same orientation with the opposite sign
  next.world_from_object.orientation.coeffs() *= -1.0;
  take(next, state);
  EXPECT_TRUE(state.velocity_known());
  EXPECT_NEAR((state.twist.linear - Vec3(1, 0, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((state.twist.angular - Vec3(0, 0.5, 0)).norm(), 0.0, 1e-9);

  take(next, state);  // repeated with the same stamp: no new information about its speed
  EXPECT_NEAR(state.twist.linear.x(), 1.0, 1e-9);

  next.has_twist = true;
  next.twist.linear = Vec3(7, 8, 9);
  next.stamp_ns += kTick;
  take(next, state);
  EXPECT_EQ(state.twist.linear, Vec3(7, 8, 9));
}

TEST(TrackedObject, VelocityIsUnknownAfterAGapAndWhileLateUnlessSent) {
  TrackedObject state;
  PoseSample next = good();
  const auto after = [&](std::int64_t after_ns, bool has_twist) {
    next.stamp_ns += after_ns;
    next.has_twist = has_twist;
    take(next, state);
    advance(kInTime, next.stamp_ns, state);
    return state.velocity_known();
  };
  EXPECT_FALSE(after(0, false));
  EXPECT_FALSE(after(0, false));  // the same stamp once more
  EXPECT_TRUE(after(40 * kTick, false)) << "the mean velocity is that of 20 ticks ago";
  EXPECT_FALSE(after(40 * kTick + 2, false));
  EXPECT_TRUE(after(kTick, false));
  EXPECT_TRUE(after(500 * kTick, true));
  advance(kInTime, next.stamp_ns + 20 * kTick + 1, state);  // late
  EXPECT_FALSE(state.velocity_known());
  EXPECT_FALSE(after(50 * kTick, false));
}

// Poses come every 30 ms and are late after 20 ms. The velocity is known while the pose is not
// late.
TEST(TrackedObject, VelocityOfASourceSlowerThanTheAgeLimitIsKnownWhileItsPoseIsNotLate) {
  TrackedObject state;
  PoseSample next = good();
  take(next, state);
  for (int pose = 1; pose < 5; ++pose) {
    next.stamp_ns += 30 * kTick;
    next.world_from_object.position.x() += 0.06;
    take(next, state);
    for (int tick = 0; tick < 30; ++tick) {
      advance(kInTime, next.stamp_ns + tick * kTick, state);
      ASSERT_EQ(state.velocity_known(), tick <= 20) << "tick " << tick;
      ASSERT_NEAR(state.twist.linear.x(), 2.0, 1e-9);
    }
  }
}

TEST(TrackedObject, FixedObjectsAreKnownToBeAtRest) {
  const TrackedObject state = initial_state(test::fixed("wall", {}, test::at(1, 2, 3)));
  EXPECT_TRUE(state.velocity_known());
  EXPECT_EQ(state.twist.linear, Vec3::Zero());
  EXPECT_EQ(state.twist.angular, Vec3::Zero());
}

TEST(TrackedObject, MotionIsTheNetOneOfATick) {
  const Object object = late_after(kTick, kInfinity);
  TrackedObject state;
  take(good(), state);
  advance(object, kStart, state);
  EXPECT_EQ(state.motion.shift, 0.0);
  PoseSample there = good(), back = good();
  there.world_from_object.position += Vec3(5, 0, 0);
  take(there, state);
  take(back, state);
  advance(object, kStart, state);
  EXPECT_EQ(state.motion.shift, 0.0);
  take(there, state);
  advance(object, kStart, state);
  EXPECT_NEAR(state.motion.shift, 5.0, 1e-12);
  advance(object, kStart, state);
  EXPECT_EQ(state.motion.shift, 0.0);
}

TEST(TrackedObject, LateObjectsMayHaveMovedAtTheirStatedSpeedSinceTheirStamp) {
  const Object stated = late_after(20 * kTick, 2.0);
  TrackedObject state;
  take(good(), state);
  advance(stated, kStart + 20 * kTick, state);
  EXPECT_FALSE(state.input.late);
  EXPECT_EQ(state.may_have_moved, 0.0);
  advance(stated, kStart + 100 * kTick, state);
  EXPECT_TRUE(state.input.late);
  EXPECT_GE(state.may_have_moved, 0.2);
  EXPECT_NEAR(state.may_have_moved, 0.2, 1e-12);
  EXPECT_EQ(state.input.age_ns(kStart + 100 * kTick), 100 * kTick);
  EXPECT_TRUE(state.known());

  advance(late_after(20 * kTick, kInfinity), kStart + 100 * kTick, state);
  EXPECT_FALSE(state.known());
}

// `response_left_ns`, as with a pose.
TEST(TrackedObject, OfALinkWhoseJointsAreOlderThanTheResponseAllowsIsLateAndMayBeAnywhere) {
  LinkState link;
  link.known = true;
  link.stamp_ns = kStart;
  Object hand = late_after(20 * kTick, kInfinity);
  hand.pose_error = 1e-6;
  TrackedObject state;
  state.bounding_radius = 0.1;
  follow(link, hand, kStart + 3 * kTick, state, 3 * kTick);
  EXPECT_FALSE(state.joints_late);
  EXPECT_EQ(state.unobserved_by_joints, 0.0);
  follow(link, hand, kStart + 3 * kTick, state, 3 * kTick - 1);
  EXPECT_TRUE(state.joints_late);
  EXPECT_EQ(state.unobserved_by_joints, kInfinity);
}

TEST(TrackedObject, AgesOfExtremeStampsDoNotOverflow) {
  PoseSample sample = good();
  sample.stamp_ns = kEarliest;
  TrackedObject state;
  take(sample, state);
  advance(late_after(0, 1.0), kLatest, state);
  EXPECT_EQ(state.input.age_ns(kLatest), kLatest);
  sample.stamp_ns = kLatest;
  take(sample, state);
  advance(late_after(0, 1.0), kEarliest, state);
  EXPECT_EQ(state.input.age_ns(kEarliest), 0);
}

TEST(Pose, IsUsableOnlyIfAllItsNumbersAreFiniteAndInReach) {
  EXPECT_TRUE(is_usable(Pose{}));
  for (const double value : {kNoNumber, std::numeric_limits<double>::infinity(), -1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      Pose pose;
      pose.position[axis] = value;
      EXPECT_FALSE(is_usable(pose)) << axis << ": " << value;
    }
    for (int number = 0; number < 4; ++number) {
      Pose pose;
      pose.orientation.coeffs()[number] = value;
      EXPECT_FALSE(is_usable(pose)) << number << ": " << value;
    }
  }
}

}  // namespace
}  // namespace clearance
