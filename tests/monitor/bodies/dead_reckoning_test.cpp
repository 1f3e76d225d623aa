// Poses and twists that contradict each other, tested through the tick.
#include "monitor/inputs/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "monitor/bodies/tracked_variable.hpp"
#include "tests/monitor/tick/two_balls.hpp"

namespace clearance {
namespace {

using test::balls_of_speed;
using test::kStart;
using test::kTick;
using test::rejected;
using test::with_twist;

TEST(DeadReckoning, PoseThatStaysWhileItsTwistSaysThatItMovesIsFrozen) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  int ticks = 0;
  for (PairStatus status = PairStatus::kConverged; status != PairStatus::kUnknown; ++ticks) {
    ASSERT_LT(ticks, 100);
    const std::int64_t now = kStart + ticks * kTick;
    const PoseSample sample = with_twist(test::at(0, 0, 0), Vec3(1, 0, 0), now);
    status = monitor.tick(std::span(&sample, 1), now).pairs[0].status;
  }
  EXPECT_NEAR(ticks, 73, 1) << "72 mm: an age limit at 2 m/s, one at 1 m/s, and a sixth of itself";
  EXPECT_GE(rejected(monitor, Reject::kFrozen), 1u);
}

// The twist is integrated over an age limit times 50. Wherever in that time the pose freezes, it is
// found after the same distance.
TEST(DeadReckoning, PoseThatFreezesAfterALongMotionIsFoundAsSoon) {
  const Scene scene = balls_of_speed(2.0);
  for (const int moves : {1, 200, 500, 900, 980, 1100}) {
    Monitor monitor(scene);
    int frozen = 0;
    PairStatus status = PairStatus::kConverged;
    for (int tick = 0; status != PairStatus::kUnknown; ++tick) {
      ASSERT_LT(frozen, 100) << moves;
      frozen = std::max(0, tick - moves);
      const std::int64_t now = kStart + tick * kTick;
      const PoseSample sample =
          with_twist(test::at(1e-3 * std::min(tick, moves), 0, 0), Vec3(1, 0, 0), now);
      status = monitor.tick(std::span(&sample, 1), now).pairs[0].status;
    }
    EXPECT_NEAR(frozen, 72, 1) << moves;
  }
}

// The reported pose stops for good, bit for bit or except for its last digit, while the object
// moves on, at times slowly. A twist comes with every sample or only with some.
TEST(DeadReckoning, PoseThatStaysBehindIsNeverKnownAgain) {
  const Scene scene = balls_of_speed(2.0);
  for (const double speed : {0.2, 0.5, 1.0}) {
    for (const auto& [digit, with_twists] : {std::pair(0.0, 1), {1e-9, 1}, {0.0, 2}}) {
      Monitor monitor(scene);
      bool found_out = false;
      for (int tick = 0; tick < 5000; ++tick) {
        const std::int64_t now = kStart + tick * kTick;
        const double slower = tick < 2000 ? 1.0 : 0.7;
        PoseSample sample = with_twist(test::at(tick % 2 == 0 ? 0.0 : digit, 0, 0),
                                       Vec3(-speed * slower, 0, 0), now);
        sample.has_twist = tick % with_twists == 0;
        (void)monitor.tick(std::span(&sample, 1), now);
        ASSERT_TRUE(!found_out || monitor.input_age(0).contradicted) << speed << ' ' << tick;
        found_out = monitor.input_age(0).contradicted;
      }
      EXPECT_TRUE(found_out) << speed;
    }
  }
}

// A contradiction that requires a shorter time does not shorten the time that an earlier one
// requires.
TEST(DeadReckoning, WildTwistDoesNotMakeAnotherContradictionEndSooner) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  bool found_out = false;
  for (int tick = 0; tick < 3000; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double twist = tick % 90 == 89 ? 4.0 : 0.3;
    const PoseSample sample = with_twist(test::at(-3e-4 * tick, 0, 0), Vec3(twist, 0, 0), now);
    (void)monitor.tick(std::span(&sample, 1), now);
    const bool contradicted = monitor.input_age(0).contradicted;
    ASSERT_TRUE(contradicted || tick < 1000) << tick;
    found_out = found_out || contradicted;
  }
  EXPECT_TRUE(found_out);
}

// The object moves back and forth with 20 m/s^2 at the turning points. Its twists are delayed by a
// whole age limit.
TEST(DeadReckoning, TwistOfAnAgeLimitAgoIsTakenWhenTheObjectTurnsBack) {
  const double speed = 1.0, turning_s = 2.0 * speed / 20.0, straight_s = 0.2;
  const auto velocity = [&](double t) {
    const double phase = std::fmod(t + 100.0, 2.0 * (turning_s + straight_s));
    const double in_half = std::fmod(phase, turning_s + straight_s);
    const double sign = phase < turning_s + straight_s ? 1.0 : -1.0;
    return sign * (in_half < straight_s ? speed : speed - 20.0 * (in_half - straight_s));
  };
  for (const int age_limit_ms : {5, 20, 50, 100}) {
    Scene scene = balls_of_speed(speed);
    scene.objects[0].age_limit_ns = age_limit_ms * kTick;
    Monitor monitor(scene);
    double x = 0.0;
    for (int tick = 0; tick < 6000; ++tick) {
      const std::int64_t now = kStart + tick * kTick;
      const double late = velocity(1e-3 * (tick - age_limit_ms));
      const PoseSample sample = with_twist(test::at(x, 0, 0), Vec3(late, 0, 0), now);
      (void)monitor.tick(std::span(&sample, 1), now);
      ASSERT_FALSE(monitor.input_age(0).contradicted) << age_limit_ms << ' ' << tick;
      x += 1e-3 * velocity(1e-3 * (tick + 0.5));
    }
  }
}

TEST(DeadReckoning, NothingFromBeforeATickThatIsToldAnEarlierTimeIsHeldAgainstPoses) {
  Scene scene = balls_of_speed(2.0);
  scene.objects[0].frozen_limit_ns = 100 * kTick;
  Monitor monitor(scene);
  const auto sample_at = [](int tick, std::int64_t now) {
    return with_twist(test::at(-1e-3 * tick, 0, 0), Vec3(-1, 0, 0), now);
  };
  for (int tick = 0; tick < 2000; ++tick) {
    const std::int64_t now = kStart + (tick - (tick < 1000 ? 0 : 60'000)) * kTick;
    const PoseSample sample = sample_at(tick == 1000 ? 999 : tick, now);
    (void)monitor.tick(std::span(&sample, 1), now);
    ASSERT_FALSE(monitor.input_age(0).contradicted) << tick;
  }
}

// Moves at 1 m/s on a circle of 0.1 m, rotated by the object's rotation about its own z axis.
PoseSample on_circle(std::int64_t stamp_ns) {
  const double angle = 10.0 * 1e-9 * static_cast<double>(stamp_ns - kStart);
  PoseSample sample = with_twist(test::at(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0),
                                 Vec3(-std::sin(angle), std::cos(angle), 0), stamp_ns);
  sample.world_from_object.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
  sample.twist.angular = Vec3(0, 0, 10);
  return sample;
}

Scene bar_of_speed(double max_speed) {
  Scene scene = test::cell_of({test::moving("bar", {test::block(Vec3(0.2, 0.05, 0.05))}),
                               test::fixed("b", {test::ball(0.1)}, test::at(3, 0, 0))});
  scene.objects[0].max_speed = max_speed;
  scene.objects[0].may_jump = false;
  return scene;
}

// The first tick of `count` after which the object is unknown; `count` if there is none.
int ticks_until_unknown(const Scene& scene, int count, auto&& sample_at) {
  Monitor monitor(scene);
  for (int tick = 0; tick < count; ++tick) {
    const PoseSample sample = sample_at(kStart + tick * kTick);
    (void)monitor.tick(std::span(&sample, 1), sample.stamp_ns);
    if (monitor.input_age(0).contradicted) return tick;
  }
  return count;
}

TEST(DeadReckoning, TwistThatIsOfThePosesIsTaken) {
  const Scene scene = bar_of_speed(4.0);
  EXPECT_EQ(ticks_until_unknown(scene, 5000, on_circle), 5000);
  const auto late = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist = on_circle(stamp_ns - 15 * kTick).twist;
    return sample;
  };
  EXPECT_EQ(ticks_until_unknown(scene, 5000, late), 5000) << "by less than the age limit";
}

TEST(DeadReckoning, TwistThatLeadsElsewhereThanThePosesIsFoundOut) {
  const Scene scene = bar_of_speed(4.0);
  const auto reversed = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist.linear *= -1.0;
    return sample;
  };
  EXPECT_LT(ticks_until_unknown(scene, 1000, reversed), 100);
  const auto without_turn = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist.angular.setZero();
    return sample;
  };
  EXPECT_LT(ticks_until_unknown(scene, 1000, without_turn), 100);
  const auto in_its_own_frame = [](std::int64_t stamp_ns) {
    PoseSample sample = on_circle(stamp_ns);
    sample.twist.linear = Vec3(0, 1, 0);
    return sample;
  };
  EXPECT_LT(ticks_until_unknown(scene, 1000, in_its_own_frame), 250);
}

// A wrong twist keeps the object unknown. Once it is right, it must agree for 51 age limits.
TEST(DeadReckoning, ObjectIsUnknownWhileItsTwistLeadsElsewhere) {
  const Scene scene = balls_of_speed(2.0);
  Monitor monitor(scene);
  int found_out = 0, known_again = 0;
  for (int tick = 0; tick < 2500; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double sign = tick < 1000 ? -1.0 : 1.0;
    const PoseSample sample = with_twist(test::at(-1e-3 * tick, 0, 0), Vec3(-sign, 0, 0), now);
    const PairStatus status = monitor.tick(std::span(&sample, 1), now).pairs[0].status;
    if (found_out == 0 && status == PairStatus::kUnknown) found_out = tick;
    if (found_out > 0 && tick < 1000) {
      ASSERT_EQ(status, PairStatus::kUnknown) << tick;
    }
    if (known_again == 0 && tick >= 1000 && status != PairStatus::kUnknown) known_again = tick;
  }
  EXPECT_GE(rejected(monitor, Reject::kOtherDirection), 1u);
  EXPECT_NEAR(found_out, 33, 1);
  EXPECT_GT(known_again, 1000);
  EXPECT_LE(known_again, 1000 + 52 * 20);
}

// A joint stands for 120 ms under velocities of 1 rad/s, and then moves so under velocities of 0. A
// driver that sends a velocity that the joint cannot have sends no true ones: its positions count.
TEST(DeadReckoning, AfterAVelocityThatTheJointCannotHaveNoPositionIsRefusedForOthers) {
  constexpr int kMoves = 120, kNever = 1000;
  for (const int wild : {0, 100, kNever}) {
    JointVariable joint;
    joint.max_speed = 2.0;
    joint.age_limit_ns = 20 * kTick;
    TrackedVariable state;
    int before = 0, after = 0;
    for (int ms = 0; ms < 200; ++ms) {
      const double velocity = ms == wild ? 1e3 : ms < kMoves ? 1.0 : 0.0;
      const JointSample sample{
          .position = 1e-3 * std::max(0, ms - kMoves), .velocity = velocity, .has_velocity = true};
      const std::int64_t now = kStart + ms * kTick;
      const auto cause =
          take(joint, sample, now, {.now_ns = now, .future_ns = kTick}, state, state.repetition);
      (ms < wild ? before : after) += cause ? 1 : 0;
    }
    EXPECT_EQ(before > 0, wild > 0) << wild;
    EXPECT_EQ(after, 0) << wild;
    EXPECT_EQ(state.velocities_contradict, wild != kNever) << wild;
  }
}

// At rest, encoders repeat their values, and a measured speed is noise.
TEST(DeadReckoning, ObjectAtRestIsNotFrozen) {
  for (const double speed : {0.25, 2.0}) {
    const Scene scene = balls_of_speed(speed);
    Monitor monitor(scene);
    Random random(6);
    for (int tick = 0; tick < 20'000; ++tick) {
      const std::int64_t now = kStart + tick * kTick;
      const PoseSample sample = with_twist(test::at(0, 0, 0), random.in_box(0.05), now);
      ASSERT_EQ(monitor.tick(std::span(&sample, 1), now).pairs[0].status, PairStatus::kConverged);
    }
  }
}

}  // namespace
}  // namespace clearance
