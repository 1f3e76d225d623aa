#include "monitor/kinematics/tracked_variable.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

namespace clearance {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// A joint with 2 rad/s between -1 and 1 rad, late after 20 ms.
class Variable : public testing::Test {
 protected:
  Variable() {
    joint_.lower = -1.0;
    joint_.upper = 1.0;
    joint_.max_speed = 2.0;
    joint_.age_limit_ns = 20 * kMs;
  }

  static JointSample at(std::int64_t stamp_ns, double position) {
    JointSample sample;
    sample.stamp_ns = stamp_ns;
    sample.position = position;
    return sample;
  }

  // Takes a sample in a tick at its stamp, or later.
  std::optional<Reject> take(const JointSample& sample, std::int64_t after_ns = 0) {
    const std::int64_t now = sample.stamp_ns + after_ns;
    const auto cause = clearance::take(joint_, sample, sample.stamp_ns,
                                       {.now_ns = now, .future_ns = 5 * kMs}, state_);
    advance(joint_, now, state_);
    return cause;
  }

  JointVariable joint_;
  TrackedVariable state_;
};

TEST_F(Variable, IsUnknownUntilItsFirstPosition) {
  advance(joint_, 5 * kMs, state_);
  EXPECT_FALSE(state_.input.has_value);
  EXPECT_EQ(state_.input.age_ns, -1);
  EXPECT_EQ(take(at(5 * kMs, 0.3)), std::nullopt);
  EXPECT_TRUE(state_.input.has_value);
  EXPECT_EQ(state_.position, 0.3);
  EXPECT_FALSE(state_.velocity_known);
}

TEST_F(Variable, VelocityIsWhatIsSentElseWhatTwoPositionsSay) {
  EXPECT_EQ(take(at(1 * kMs, 0.0)), std::nullopt);
  EXPECT_EQ(take(at(2 * kMs, 0.001)), std::nullopt);
  EXPECT_TRUE(state_.velocity_known);
  EXPECT_NEAR(state_.velocity, 1.0, 1e-12);
  JointSample sample = at(3 * kMs, 0.002);
  sample.has_velocity = true;
  sample.velocity = -0.5;
  EXPECT_EQ(take(sample), std::nullopt);
  EXPECT_EQ(state_.velocity, -0.5);
  // A driver that measures no velocity sends NaN.
  sample = at(4 * kMs, 0.003);
  sample.has_velocity = true;
  sample.velocity = kNotANumber;
  EXPECT_EQ(take(sample), std::nullopt);
  EXPECT_NEAR(state_.velocity, 1.0, 1e-12);
  // After a long gap, a difference of positions says nothing about the present velocity.
  EXPECT_EQ(take(at(100 * kMs, 0.1)), std::nullopt);
  EXPECT_FALSE(state_.velocity_known);
}

TEST_F(Variable, LateItMayHaveGoneAsFastAsItGoesButNotBeyondItsLimits) {
  EXPECT_EQ(take(at(0, 0.5)), std::nullopt);
  advance(joint_, 20 * kMs, state_);
  EXPECT_FALSE(state_.input.late);
  EXPECT_EQ(state_.may_have_moved, 0.0);
  advance(joint_, 30 * kMs, state_);
  EXPECT_TRUE(state_.input.late);
  EXPECT_NEAR(state_.may_have_moved, 0.06, 1e-12);
  advance(joint_, 10'000 * kMs, state_);
  EXPECT_NEAR(state_.may_have_moved, 1.5, 1e-12);
  joint_.max_speed = kUnlimited;
  advance(joint_, 10'000 * kMs, state_);
  EXPECT_NEAR(state_.may_have_moved, 1.5, 1e-12);
  joint_.lower = -kUnlimited;
  advance(joint_, 10'000 * kMs, state_);
  EXPECT_EQ(state_.may_have_moved, kUnlimited);
}

TEST_F(Variable, WhatItWasSeenToExceedDoesNotBoundIt) {
  EXPECT_EQ(take(at(0, 1.01)), std::nullopt);
  advance(joint_, 10'000 * kMs, state_);
  EXPECT_NEAR(state_.may_have_moved, 20.0, 1e-9);
  state_ = {};
  JointSample fast = at(0, 0.0);
  fast.has_velocity = true;
  fast.velocity = -5.0;
  EXPECT_EQ(take(fast), std::nullopt);
  advance(joint_, 100 * kMs, state_);
  EXPECT_NEAR(state_.may_have_moved, 0.5, 1e-12);
}

// If two positions exclude each other, it is unknown which one is wrong, so only the limits hold.
TEST_F(Variable, PositionsThatItCannotHaveAreRefusedAndNothingButItsLimitsIsKnown) {
  EXPECT_EQ(take(at(0, 0.8)), std::nullopt);
  EXPECT_EQ(take(at(10 * kMs, 0.0)), Reject::kTooFast);
  EXPECT_TRUE(state_.input.late);
  EXPECT_TRUE(state_.input.contradicted);
  EXPECT_EQ(state_.position, 0.8);
  EXPECT_NEAR(state_.may_have_moved, 1.8, 1e-12);
  // This lasts until a position agrees again and an age limit has passed.
  EXPECT_EQ(take(at(11 * kMs, 0.79)), std::nullopt);
  EXPECT_TRUE(state_.input.contradicted);
  EXPECT_EQ(take(at(31 * kMs, 0.79)), std::nullopt);
  EXPECT_FALSE(state_.input.late);
  // If the positions persist, they are accepted once the joint can have reached them.
  EXPECT_EQ(take(at(200 * kMs, 0.0)), Reject::kTooFast);
  EXPECT_EQ(take(at(420 * kMs, 0.0)), std::nullopt);
  joint_.upper = kUnlimited;
  EXPECT_EQ(take(at(421 * kMs, 0.9)), Reject::kTooFast);
  EXPECT_EQ(state_.may_have_moved, kUnlimited);
}

// Many robot descriptions state wrong velocity limits.
TEST_F(Variable, AVelocityThatIsSentMayExceedTheLimitAndSoMayTheWay) {
  JointSample fast = at(0, 0.0);
  fast.has_velocity = true;
  fast.velocity = 6.0;
  EXPECT_EQ(take(fast), std::nullopt);
  fast.stamp_ns = 100 * kMs;
  fast.position = 0.6;
  EXPECT_EQ(take(fast), std::nullopt);
  EXPECT_EQ(take(at(101 * kMs, 0.9)), Reject::kTooFast);
}

TEST_F(Variable, WildVelocityDoesNotExcuseALeap) {
  EXPECT_EQ(take(at(0, -0.5)), std::nullopt);
  JointSample wild = at(kMs, 0.5);
  wild.has_velocity = true;
  wild.velocity = 1e6;
  EXPECT_EQ(take(wild), Reject::kTooFast);
  wild.stamp_ns = 2 * kMs;
  wild.position = -0.5;
  EXPECT_EQ(take(wild), std::nullopt);
  EXPECT_EQ(take(at(3 * kMs, 0.5)), Reject::kTooFast) << "nor does that of the one before";
}

TEST_F(Variable, WhatIsNoPositionOrOutOfTimeIsRefused) {
  EXPECT_EQ(take(at(10 * kMs, 0.0)), std::nullopt);
  EXPECT_EQ(take(at(11 * kMs, kNotANumber)), Reject::kNonFinite);
  EXPECT_EQ(take(at(11 * kMs, 2e6)), Reject::kNonFinite);
  EXPECT_EQ(take(at(9 * kMs, 0.0), 2 * kMs), Reject::kBackwards);
  EXPECT_FALSE(state_.input.contradicted);
  EXPECT_EQ(take(at(30 * kMs, 0.0), -6 * kMs), Reject::kFuture);
  EXPECT_TRUE(state_.input.contradicted);
  EXPECT_EQ(state_.input.stamp_ns, 10 * kMs);
}

TEST_F(Variable, BelongsToTheFirstThatSendsItUntilThatIsSilent) {
  JointSample other = at(2 * kMs, 0.0);
  other.source = 3;
  EXPECT_EQ(take(at(1 * kMs, 0.0)), std::nullopt);
  EXPECT_EQ(take(other), Reject::kOtherSource);
  EXPECT_EQ(state_.input.owner.other_source(), 3u);
  other.stamp_ns = 1002 * kMs;
  EXPECT_EQ(take(other), std::nullopt);
  EXPECT_EQ(state_.input.owner.source(), 3u);
  state_.input.owner = InputOwner(3);
  EXPECT_EQ(take(at(9000 * kMs, 0.0)), Reject::kOtherSource);
}

TEST_F(Variable, AfterTimeThatNobodyCanTellItIsLate) {
  EXPECT_EQ(take(at(1 * kMs, 0.0)), std::nullopt);
  state_.input.forget_age(-5 * kMs);
  advance(joint_, -5 * kMs, state_);
  EXPECT_TRUE(state_.input.late);
  EXPECT_EQ(take(at(-4 * kMs, 0.9)), std::nullopt);
  EXPECT_FALSE(state_.input.late);
}

}  // namespace
}  // namespace clearance
