#include "monitor/bodies/tracked_variable.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace clearance {
namespace {

constexpr std::int64_t kVariableMs = 1'000'000;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kUnlimited = std::numeric_limits<double>::infinity();

// A joint with 2 rad/s between -1 and 1 rad, late after 20 ms.
class Variable : public testing::Test {
 protected:
  Variable() {
    joint_.lower = -1.0;
    joint_.upper = 1.0;
    joint_.max_speed = 2.0;
    joint_.age_limit_ns = 20 * kVariableMs;
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
    const auto cause =
        clearance::take(joint_, sample, sample.stamp_ns,
                        {.now_ns = now, .future_ns = 5 * kVariableMs}, state_, state_.repetition);
    advance(joint_, now, state_);
    return cause;
  }

  JointVariable joint_;
  TrackedVariable state_;
};

TEST_F(Variable, IsUnknownUntilItsFirstPosition) {
  advance(joint_, 5 * kVariableMs, state_);
  EXPECT_FALSE(state_.input.has_value);
  EXPECT_EQ(state_.input.age_ns(5 * kVariableMs), -1);
  EXPECT_EQ(take(at(5 * kVariableMs, 0.3)), std::nullopt);
  EXPECT_TRUE(state_.input.has_value);
  EXPECT_EQ(state_.position, 0.3);
  EXPECT_FALSE(state_.velocity_known);
}

TEST_F(Variable, VelocityIsWhatIsSentElseWhatTwoPositionsSay) {
  EXPECT_EQ(take(at(1 * kVariableMs, 0.0)), std::nullopt);
  EXPECT_EQ(take(at(2 * kVariableMs, 0.001)), std::nullopt);
  EXPECT_TRUE(state_.velocity_known);
  EXPECT_NEAR(state_.velocity, 1.0, 1e-12);
  JointSample sample = at(3 * kVariableMs, 0.002);
  sample.has_velocity = true;
  sample.velocity = -0.5;
  EXPECT_EQ(take(sample), std::nullopt);
  EXPECT_EQ(state_.velocity, -0.5);
  // A driver that measures no velocity sends NaN.
  sample = at(4 * kVariableMs, 0.003);
  sample.has_velocity = true;
  sample.velocity = kNotANumber;
  EXPECT_EQ(take(sample), std::nullopt);
  EXPECT_NEAR(state_.velocity, 1.0, 1e-12);
  // After a long gap, a difference of positions says nothing about the present velocity.
  EXPECT_EQ(take(at(100 * kVariableMs, 0.1)), std::nullopt);
  EXPECT_FALSE(state_.velocity_known);
}

TEST_F(Variable, LateItMayHaveGoneAsFastAsItGoesButNotBeyondItsLimits) {
  EXPECT_EQ(take(at(0, 0.5)), std::nullopt);
  advance(joint_, 20 * kVariableMs, state_);
  EXPECT_FALSE(state_.input.late);
  EXPECT_EQ(state_.may_have_moved, 0.0);
  advance(joint_, 30 * kVariableMs, state_);
  EXPECT_TRUE(state_.input.late);
  EXPECT_NEAR(state_.may_have_moved, 0.06, 1e-12);
  advance(joint_, 10'000 * kVariableMs, state_);
  EXPECT_NEAR(state_.may_have_moved, 1.5, 1e-12);
  joint_.max_speed = kUnlimited;
  advance(joint_, 10'000 * kVariableMs, state_);
  EXPECT_NEAR(state_.may_have_moved, 1.5, 1e-12);
  joint_.lower = -kUnlimited;
  advance(joint_, 10'000 * kVariableMs, state_);
  EXPECT_EQ(state_.may_have_moved, kUnlimited);
}

TEST_F(Variable, WhatItWasSeenToExceedDoesNotBoundIt) {
  JointSample fast = at(0, 0.0);
  fast.has_velocity = true;
  fast.velocity = -5.0;
  EXPECT_EQ(take(fast), std::nullopt);
  advance(joint_, 100 * kVariableMs, state_);
  EXPECT_NEAR(state_.may_have_moved, 0.5, 1e-12);
}

// If two positions exclude each other, it is unknown which one is wrong, so only the limits hold.
TEST_F(Variable, PositionsThatItCannotHaveAreRefusedAndNothingButItsLimitsIsKnown) {
  EXPECT_EQ(take(at(0, 0.8)), std::nullopt);
  EXPECT_EQ(take(at(10 * kVariableMs, 0.0)), Reject::kTooFast);
  EXPECT_TRUE(state_.input.late);
  EXPECT_TRUE(state_.input.contradicted);
  EXPECT_EQ(state_.position, 0.8);
  EXPECT_NEAR(state_.may_have_moved, 1.8, 1e-12);
  // This lasts until a position agrees again and an age limit has passed.
  EXPECT_EQ(take(at(11 * kVariableMs, 0.79)), std::nullopt);
  EXPECT_TRUE(state_.input.contradicted);
  EXPECT_EQ(take(at(31 * kVariableMs, 0.79)), std::nullopt);
  EXPECT_FALSE(state_.input.late);
  // If the positions persist, they are accepted once the joint can have reached them.
  EXPECT_EQ(take(at(200 * kVariableMs, 0.0)), Reject::kTooFast);
  EXPECT_EQ(take(at(420 * kVariableMs, 0.0)), std::nullopt);
  joint_.upper = kUnlimited;
  EXPECT_EQ(take(at(421 * kVariableMs, 0.9)), Reject::kTooFast);
  EXPECT_EQ(state_.may_have_moved, kUnlimited);
}

// Many robot descriptions state wrong velocity limits.
TEST_F(Variable, AVelocityThatIsSentMayExceedTheLimitAndSoMayThePath) {
  JointSample fast = at(0, 0.0);
  fast.has_velocity = true;
  fast.velocity = 6.0;
  EXPECT_EQ(take(fast), std::nullopt);
  fast.stamp_ns = 100 * kVariableMs;
  fast.position = 0.6;
  EXPECT_EQ(take(fast), std::nullopt);
  EXPECT_EQ(take(at(101 * kVariableMs, 0.9)), Reject::kTooFast);
}

TEST_F(Variable, WildVelocityDoesNotExcuseALeap) {
  EXPECT_EQ(take(at(0, -0.5)), std::nullopt);
  JointSample wild = at(kVariableMs, 0.5);
  wild.has_velocity = true;
  wild.velocity = 1e6;
  EXPECT_EQ(take(wild), Reject::kTooFast);
  wild.stamp_ns = 2 * kVariableMs;
  wild.position = -0.5;
  EXPECT_EQ(take(wild), std::nullopt);
  EXPECT_EQ(take(at(3 * kVariableMs, 0.5)), Reject::kTooFast) << "nor does that of the one before";
}

TEST_F(Variable, WhatIsNoPositionOrOutOfTimeIsRefused) {
  EXPECT_EQ(take(at(10 * kVariableMs, 0.0)), std::nullopt);
  EXPECT_EQ(take(at(11 * kVariableMs, kNotANumber)), Reject::kNonFinite);
  EXPECT_EQ(take(at(11 * kVariableMs, 2e6)), Reject::kNonFinite);
  EXPECT_EQ(take(at(9 * kVariableMs, 0.0), 2 * kVariableMs), Reject::kBackwards);
  EXPECT_FALSE(state_.input.contradicted);
  EXPECT_EQ(take(at(30 * kVariableMs, 0.0), -6 * kVariableMs), Reject::kFuture);
  EXPECT_TRUE(state_.input.contradicted);
  EXPECT_EQ(state_.input.stamp_ns, 10 * kVariableMs);
}

TEST_F(Variable, BelongsToTheFirstThatSendsItUntilThatIsSilent) {
  JointSample other = at(2 * kVariableMs, 0.0);
  other.source = 3;
  EXPECT_EQ(take(at(1 * kVariableMs, 0.0)), std::nullopt);
  EXPECT_EQ(take(other), Reject::kOtherSource);
  EXPECT_EQ(state_.input.owner.other_source(2 * kVariableMs), 3u);
  other.stamp_ns = 1002 * kVariableMs;
  EXPECT_EQ(take(other), std::nullopt);
  EXPECT_EQ(state_.input.owner.source(), 3u);
  state_.input.owner = InputOwner(3);
  EXPECT_EQ(take(at(9000 * kVariableMs, 0.0)), Reject::kOtherSource);
}

TEST_F(Variable, AfterTimeThatNobodyCanTellItIsLate) {
  EXPECT_EQ(take(at(1 * kVariableMs, 0.0)), std::nullopt);
  forget_age(-5 * kVariableMs, state_);
  advance(joint_, -5 * kVariableMs, state_);
  EXPECT_TRUE(state_.input.late);
  EXPECT_EQ(take(at(-4 * kVariableMs, 0.9)), std::nullopt);
  EXPECT_FALSE(state_.input.late);
}

// A joint that swings, and what a driver that lies sends of it: positions and velocities.
class LyingVariable : public Variable {
 protected:
  static constexpr double kAmplitude = 0.4, kRate = 3.0;  // rad, rad/s: at most 1.2 rad/s
  static double truth(std::int64_t ns) { return kAmplitude * std::sin(kRate * 1e-9 * double(ns)); }
  static double speed(std::int64_t ns) {
    return kAmplitude * kRate * std::cos(kRate * 1e-9 * double(ns));
  }
  std::optional<Reject> take_both(std::int64_t ns, double position, double velocity) {
    JointSample sample = at(ns, position);
    sample.has_velocity = true;
    sample.velocity = velocity;
    return take(sample);
  }
  // The largest error of the position in use while the joint counts as known, from this time on.
  template <class Position>
  double largest_error(std::int64_t from_ms, std::int64_t to_ms, Position position) {
    double largest = 0.0;
    for (std::int64_t ms = from_ms; ms < to_ms; ++ms) {
      static_cast<void>(
          take_both(ms * kVariableMs, position(ms * kVariableMs), speed(ms * kVariableMs)));
      if (!state_.input.late)
        largest = std::max(largest, std::abs(state_.position - truth(ms * kVariableMs)));
    }
    return largest;
  }
};

TEST_F(LyingVariable, FrozenPositionsUnderVelocitiesThatMoveAreFoundOut) {
  EXPECT_LT(largest_error(0, 1000, [](std::int64_t ns) { return truth(ns); }), 1e-12);
  EXPECT_LT(largest_error(1000, 4000, [](std::int64_t) { return truth(1000 * kVariableMs); }),
            0.12);
  // The true positions are taken at once, and known when they have agreed for long enough.
  EXPECT_EQ(take_both(4001 * kVariableMs, truth(4001 * kVariableMs), speed(4001 * kVariableMs)),
            std::nullopt);
  EXPECT_TRUE(state_.input.late);
  EXPECT_LT(largest_error(4002, 5200, [](std::int64_t ns) { return truth(ns); }), 1e-12);
  EXPECT_FALSE(state_.input.late);
}

TEST_F(LyingVariable, PositionsAtHalfTheSpeedAreFoundOut) {
  EXPECT_LT(largest_error(0, 4000, [](std::int64_t ns) { return 0.5 * truth(ns); }), 0.12);
  EXPECT_TRUE(state_.input.late);
}

TEST_F(LyingVariable, VelocitiesOfZeroYieldToDifferences) {
  bool is_told = false;
  for (std::int64_t ms = 0; ms < 3000; ++ms) {
    ASSERT_EQ(take_both(ms * kVariableMs, truth(ms * kVariableMs), 0.0), std::nullopt);
    is_told = is_told || state_.velocities_contradict;
    ASSERT_FALSE(state_.input.late);
    if (ms > 20) {
      ASSERT_NEAR(state_.velocity, speed(ms * kVariableMs), 0.01) << ms;
    }
  }
  EXPECT_TRUE(is_told);
  // Velocities that move and agree are used again.
  for (std::int64_t ms = 3000; ms < 4000; ++ms) {
    ASSERT_EQ(take_both(ms * kVariableMs, truth(ms * kVariableMs), speed(ms * kVariableMs)),
              std::nullopt);
  }
  EXPECT_FALSE(state_.velocities_contradict);
  EXPECT_EQ(state_.velocity, speed(3999 * kVariableMs));
}

// The larger of the two speeds counts, in the direction of the positions.
TEST_F(LyingVariable, VelocitiesOfTheWrongSignYieldToPositions) {
  for (std::int64_t ms = 0; ms < 2000; ++ms) {
    ASSERT_EQ(take_both(ms * kVariableMs, truth(ms * kVariableMs), -speed(ms * kVariableMs)),
              std::nullopt)
        << ms;
    if (ms > 60) {
      ASSERT_NEAR(state_.velocity, speed(ms * kVariableMs), 0.01) << ms;
    }
  }
}

// Comparisons begin anew now and then, so the last one began at any time before.
TEST_F(LyingVariable, VelocitiesThatBecomeWrongAfterALongMotionAreFoundAsSoon) {
  for (const double factor : {0.0, -1.0, -0.5}) {
    for (int moves = 1; moves < 1500; moves += 13) {
      state_ = {};
      for (int ms = 0; ms < moves || !state_.velocities_contradict; ++ms) {
        ASSERT_LT(ms, moves + 85) << factor;
        const double sent = ms < moves ? 1.0 : factor;
        ASSERT_EQ(take_both(ms * kVariableMs, 1e-3 * ms - 0.8, sent), std::nullopt) << ms;
      }
    }
  }
}

// At half the speed, positions move against velocities where the joint has turned back meanwhile.
TEST_F(LyingVariable, PositionsThatLagBehindAJointThatTurnsBackAreNotBelievedAgain) {
  joint_.max_speed = 1.5;
  const double most = 10.5 * joint_.max_speed * 1e-9 * static_cast<double>(joint_.age_limit_ns);
  const auto angle = [](double ms) { return 1.3e-3 * ms; };
  for (int from = 1000; from < 6000; from += 100) {
    state_ = {};
    for (int ms = 0; ms < from + 2000; ++ms) {
      const double told = ms < from ? ms : 0.5 * (from + ms);
      const double velocity = 0.9 * 1.3 * std::cos(angle(ms));
      static_cast<void>(take_both(ms * kVariableMs, 0.9 * std::sin(angle(told)), velocity));
      const double error = std::abs(state_.position - 0.9 * std::sin(angle(ms)));
      ASSERT_LT(state_.input.late ? 0.0 : error, most) << "from " << from << " at " << ms;
    }
  }
}

// Several messages place a base on tf together: its positions come in steps of other sizes than
// their times, and its velocities are differences of each message's own.
TEST_F(LyingVariable, VelocitiesThatAreDifferencesThemselvesAreNotContradicted) {
  joint_.velocity_is_difference = true;
  for (std::int64_t ms = 0; ms < 100; ++ms) {
    const double sent = ms < 50 ? 0.0 : speed(ms * kVariableMs);
    ASSERT_EQ(take_both(ms * kVariableMs, truth(ms / 2 * 2 * kVariableMs), sent), std::nullopt);
    ASSERT_FALSE(state_.velocities_contradict);
    ASSERT_EQ(state_.velocity, sent);
  }
}

TEST_F(LyingVariable, VelocitiesThatTheJointCannotHaveAreNotUsed) {
  for (std::int64_t ms = 0; ms < 1000; ++ms) {
    ASSERT_EQ(take_both(ms * kVariableMs, truth(ms * kVariableMs), 1e3), std::nullopt);
    if (ms > 0) {
      ASSERT_LT(std::abs(state_.velocity), 1.3);
    }
  }
  EXPECT_TRUE(state_.velocities_contradict);
}

TEST_F(Variable, OutsideItsLimitsItIsRefusedAndNothingBoundsIt) {
  joint_.limit_tolerance = 0.02;
  EXPECT_EQ(take(at(0, 1.015)), std::nullopt) << "encoders have offsets";
  EXPECT_EQ(take(at(10 * kVariableMs, 1.03)), Reject::kOutsideLimits);
  EXPECT_EQ(state_.may_have_moved, kUnlimited);
  EXPECT_EQ(take(at(20 * kVariableMs, 1.0)), std::nullopt);
  EXPECT_TRUE(state_.input.contradicted);
  EXPECT_EQ(take(at(41 * kVariableMs, 1.0)), std::nullopt);
  EXPECT_FALSE(state_.input.late);
}

TEST_F(Variable, ThatWrapsMakesNoLeapWhereItsAngleDoes) {
  joint_.lower = -kUnlimited;
  joint_.upper = kUnlimited;
  joint_.wraps = true;
  EXPECT_EQ(take(at(0, 3.1406)), std::nullopt);
  EXPECT_EQ(take(at(1 * kVariableMs, -3.1416)), std::nullopt);
  EXPECT_NEAR(state_.velocity, 1.0, 0.02);
  EXPECT_EQ(take(at(2 * kVariableMs, 3.1416 + 6.283185307179586 * 1000)), std::nullopt);
  EXPECT_EQ(take(at(3 * kVariableMs, 0.0)), Reject::kTooFast);
  joint_.wraps = false;
  EXPECT_EQ(take(at(4 * kVariableMs, 3.1416)), Reject::kTooFast);
}

TEST_F(Variable, ThatDriftsFasterThanItMovesIsFoundOut) {
  double position = -0.9;
  std::int64_t ms = 0;
  while (take(at(ms * kVariableMs, position)) == std::nullopt) {
    ASSERT_LT(++ms, 400);
    position += 0.0045;  // 4.5 rad/s, of 2
  }
  EXPECT_LT(position + 0.9 - 2.0 * 1e-3 * double(ms), 0.05) << "no farther off than an age limit";
}

TEST_F(Variable, ThatMayNotStandStillIsFrozenWhenItDoes) {
  joint_.frozen_limit_ns = 50 * kVariableMs;
  EXPECT_EQ(take(at(0, 0.1)), std::nullopt);
  EXPECT_EQ(take(at(50 * kVariableMs, 0.1)), std::nullopt);
  EXPECT_EQ(take(at(51 * kVariableMs, 0.1)), Reject::kFrozen);
  EXPECT_TRUE(state_.input.contradicted);
}

// Whoever came first: two sources cannot both be right.
TEST_F(Variable, ThatTwoSourcesContradictIsUnknownWhileTheyDo) {
  for (std::int64_t ms = 0; ms < 500; ++ms) {
    ASSERT_EQ(take(at(ms * kVariableMs, 0.0)), std::nullopt);
    JointSample other = at(ms * kVariableMs, 0.5);
    other.source = 3;
    ASSERT_EQ(take(other), Reject::kDisputed);
    ASSERT_TRUE(state_.input.contradicted);
  }
  // One of them ends. A second later, the other is trusted.
  std::int64_t ms = 500;
  for (; state_.input.contradicted; ++ms) {
    ASSERT_LT(ms, 2000);
    ASSERT_EQ(take(at(ms * kVariableMs, 0.0)), std::nullopt);
  }
  EXPECT_NEAR(static_cast<double>(ms), 1500.0, 2.0);
  // A source that the cell names is not disputed.
  state_.input.owner = InputOwner(0);
  JointSample other = at(ms * kVariableMs, 0.5);
  other.source = 3;
  EXPECT_EQ(take(other), Reject::kOtherSource);
  EXPECT_FALSE(state_.input.contradicted);
}

// The owner sends what cannot be, but it is not silent.
TEST_F(Variable, ThatIsRefusedKeepsItsOwner) {
  EXPECT_EQ(take(at(0, 0.0)), std::nullopt);
  for (std::int64_t ms = 1; ms < 3000; ++ms) {
    static_cast<void>(take(at(ms * kVariableMs, ms % 2 == 0 ? kNotANumber : 5.0)));
    JointSample other = at(ms * kVariableMs, 0.0);
    other.source = 3;
    ASSERT_EQ(take(other), Reject::kOtherSource) << ms;
  }
  EXPECT_EQ(state_.input.owner.takeovers(), 0u);
  JointSample other = at(4001 * kVariableMs, 0.0);
  other.source = 3;
  EXPECT_EQ(take(other), std::nullopt);
  EXPECT_EQ(state_.input.owner.takeovers(), 1u);
  EXPECT_EQ(state_.input.owner.former_source(), 0u);
}

}  // namespace
}  // namespace clearance
