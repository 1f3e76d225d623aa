// How commands are slowed down, held and resumed. What a machine would do is judged by the
// differences of the commands alone.
#include "tools/ros2/clearance_control/limiter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/shared/allocation_count.hpp"
#include "tests/shared/random.hpp"

namespace clearance_control {
namespace {

using Kind = Limiter::Kind;
using Values = std::vector<double>;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep = 1e-3;  // s
constexpr Permitted kFree{.scaling = 1.0}, kHold{.scaling = 0.0};
const std::vector<JointLimits> kLimits = {{1.0, 5.0}, {2.0, 4.0}};

// A limiter, and the velocities that follow from its commands.
struct Machine {
  explicit Machine(Kind of, const Values& begin = {0.0, 0.0})
      : kind(of), limiter(of, kLimits), commands(begin), velocities(begin.size()) {
    limiter.start(begin);
    if (kind == Kind::kVelocity) velocities = begin;
  }
  void update(const Values& references, const Permitted& permitted = kFree, double dt_s = kStep) {
    const Values before = commands, velocities_before = velocities;
    limiter.update(references, permitted, dt_s, commands);
    acceleration = 0.0;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      velocities[i] = kind == Kind::kVelocity ? commands[i] : (commands[i] - before[i]) / dt_s;
      const double change = std::abs(velocities[i] - velocities_before[i]);
      acceleration = std::max(acceleration, change / dt_s / kLimits[i].deceleration);
    }
  }
  [[nodiscard]] double speed() const {
    double most = 0.0;
    for (std::size_t i = 0; i < velocities.size(); ++i)
      most = std::max(most, std::abs(velocities[i]) / kLimits[i].max_velocity);
    return most;
  }

  Kind kind;
  Limiter limiter;
  Values commands, velocities;
  double acceleration = 0.0;  // of the last update, in units of the stated deceleration
};

Values swing(double t_s) { return {0.5 * std::sin(1.5 * t_s), 0.3 * std::sin(1.1 * t_s)}; }

class EachKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Limiter, EachKind, testing::Values(Kind::kPosition, Kind::kVelocity));

TEST_P(EachKind, LetsCommandsPassToTheBitWhereNothingLimits) {
  Machine machine(GetParam());
  for (int k = 0; k < 3000; ++k) {
    const Values references = swing(k * kStep);
    machine.update(references);
    if (k < 1000) continue;  // it begins at rest
    ASSERT_TRUE(machine.limiter.passes()) << k;
    ASSERT_EQ(machine.commands, references) << k;
  }
}

// References leap, fall silent and turn; permits change at any time; updates are late.
TEST_P(EachKind, KeepsTheStatedDecelerationAndSpeedWhateverComes) {
  clearance::Random random(GetParam() == Kind::kPosition ? 1 : 2);
  for (int run = 0; run < 100; ++run) {
    Machine machine(GetParam());
    Values references(2);
    Permitted permitted = kFree;
    double held_s = 0.0;
    for (int k = 0; k < 1500; ++k) {
      if (random.chance(0.005)) {
        permitted.scaling = random.chance(0.3) ? 1.0 : random.chance(0.5) ? 0.0 : random.unit();
        permitted.most_speed = random.chance(0.7) ? 1.0 : random.unit();
      }
      for (double& reference : references) {
        if (random.chance(0.02) || std::isnan(reference)) reference = random.uniform(-2.0, 2.0);
        reference += random.uniform(-1e-4, 1e-4);
        if (random.chance(0.002)) reference = kNaN;
      }
      const double dt_s = random.chance(0.1) ? random.uniform(1e-4, 1e-2) : kStep;
      const bool passed = machine.limiter.passes();
      machine.update(references, permitted, dt_s);
      held_s = permitted.scaling == 0.0 ? held_s + dt_s : 0.0;
      ASSERT_LE(machine.speed(), 1.0 + 1e-9) << run << ' ' << k;
      if (!passed || !machine.limiter.passes()) {
        ASSERT_LE(machine.acceleration, 1.0 + 1e-6) << run << ' ' << k;
      }
      // From full speed, the slower joint needs 0.5 s.
      if (held_s > 0.51) {
        ASSERT_EQ(machine.speed(), 0.0) << run << ' ' << k;
      }
    }
  }
}

TEST_P(EachKind, StandsAfterItsSpeedOverTheDecelerationAndKeepsItsDirection) {
  Machine machine(GetParam());
  double t_s = 0.0;
  const auto references = [&] {
    t_s += kStep;
    return GetParam() == Kind::kPosition ? Values{0.6 * t_s, -0.8 * t_s} : Values{0.6, -0.8};
  };
  while (t_s < 1.0) machine.update(references());
  ASSERT_TRUE(machine.limiter.passes());
  // The slower one, of 0.8 at 4, takes 0.2 s.
  int held = 0;
  for (; machine.speed() > 1e-12 && held < 1000; ++held) {
    machine.update(references(), kHold);
    ASSERT_NEAR(machine.velocities[0] * -0.8, machine.velocities[1] * 0.6, 1e-9);
  }
  EXPECT_NEAR(held * kStep, 0.2, 1.5 * kStep);
  const Values stands = machine.commands;
  machine.update(references(), kHold);
  EXPECT_EQ(machine.commands, stands);
}

TEST_P(EachKind, ResumesWithoutAJumpAndPassesAgain) {
  Machine machine(GetParam());
  int k = 0;
  for (; k < 2000; ++k) machine.update(swing(k * kStep), k < 1000 ? kFree : kHold);
  ASSERT_EQ(machine.speed(), 0.0);
  for (; k < 6000 && !machine.limiter.passes(); ++k) {
    machine.update(swing(k * kStep));
    ASSERT_LE(machine.acceleration, 1.0 + 1e-6) << k;
  }
  EXPECT_TRUE(machine.limiter.passes());
  EXPECT_EQ(machine.commands, swing((k - 1) * kStep));
}

TEST_P(EachKind, HoldsAtAReferenceThatIsNoNumber) {
  Machine machine(GetParam());
  for (int k = 0; k < 1500; ++k) machine.update(swing(k * kStep));
  for (int k = 0; k < 500; ++k) machine.update({kNaN, 0.3});
  EXPECT_EQ(machine.speed(), 0.0);
  EXPECT_TRUE(
      std::ranges::all_of(machine.commands, [](double each) { return std::isfinite(each); }));
}

TEST_P(EachKind, RepeatsItsCommandsIfNoTimeHasPassed) {
  Machine machine(GetParam());
  for (int k = 0; k < 1500; ++k) machine.update(swing(k * kStep));
  const Values before = machine.commands;
  machine.limiter.update(Values{1.0, 1.0}, kFree, 0.0, machine.commands);
  EXPECT_EQ(machine.commands, before);
}

TEST_P(EachKind, AllocatesNothing) {
  Machine machine(GetParam());
  const Values references = {0.1, kNaN};
  const std::uint64_t before = clearance::allocations();
  for (int k = 0; k < 100; ++k)
    machine.limiter.update(references, k < 50 ? kFree : kHold, kStep, machine.commands);
  EXPECT_EQ(clearance::allocations(), before);
}

// References are far beyond what the joints can do.
TEST_P(EachKind, KeepsToThePermittedSpeed) {
  for (const Permitted& permitted :
       {Permitted{0.5, 1.0}, Permitted{1.0, 0.25}, Permitted{0.3, 0.4}}) {
    Machine machine(GetParam());
    for (int k = 0; k < 1000; ++k) machine.update({50.0, -3.0}, permitted);
    EXPECT_NEAR(machine.speed(), std::min(permitted.scaling, permitted.most_speed), 1e-9);
  }
}

TEST(Limiter, ScalesVelocitiesInProportion) {
  Machine machine(Kind::kVelocity);
  for (int k = 0; k < 1000; ++k) machine.update({0.6, -0.8}, {.scaling = 0.25});
  EXPECT_NEAR(machine.commands[0], 0.15, 1e-12);
  EXPECT_NEAR(machine.commands[1], -0.2, 1e-12);
}

TEST(Limiter, FollowsPositionsNoFasterThanTheScaledLimit) {
  Machine machine(Kind::kPosition);
  for (int k = 0; k < 1000; ++k) machine.update({5.0, 0.0}, {.scaling = 0.25});
  EXPECT_NEAR(machine.velocities[0], 0.25, 1e-9);
  EXPECT_NEAR(machine.velocities[1], 0.0, 1e-9);
}

TEST(Limiter, BeginsWhereTheJointsStand) {
  Machine machine(Kind::kPosition, {0.3, -0.2});
  machine.update({0.3, -0.2});
  EXPECT_EQ(machine.commands, (Values{0.3, -0.2}));
  EXPECT_EQ(machine.speed(), 0.0);
}

TEST(Limiter, GoesToAFarPositionAndStandsThereWithoutOvershoot) {
  for (const Values& far : {Values{0.5, -0.5}, Values{1.0, -0.1}, Values{0.1, -2.0}}) {
    Machine machine(Kind::kPosition);
    for (int k = 0; k < 5000; ++k) {
      machine.update(far);
      ASSERT_LE(machine.commands[0], far[0]);
      ASSERT_GE(machine.commands[1], far[1]);
      ASSERT_LE(machine.acceleration, 1.0 + 1e-6) << k;
    }
    EXPECT_EQ(machine.commands, far);
  }
}

}  // namespace
}  // namespace clearance_control
