// S_p compared with the motion of a walking person and a braking robot in long double, and its
// laws.
#include "monitor/zones/protective_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// A robot that brakes with this deceleration, m/s2. In a trial it was stopped from the speed
// `tried_at`, m/s.
Separation braking(double deceleration, double tried_at, double reaction_s) {
  Separation terms;
  terms.reaction_time_ns = std::llround(reaction_s * 1e9);
  terms.stopping_time_ns = std::llround(tried_at / deceleration * 1e9);
  terms.stopping_distance = 0.5 * tried_at * tried_at / deceleration;
  terms.stopping_speed = tried_at;
  return terms;
}

// The distance that both cover until the robot stands, from the equations of motion. The person
// moves all the time; the robot accelerates until it brakes.
long double covered(long double human_speed, long double human_acceleration, long double speed,
                    long double gain, long double reaction, long double deceleration) {
  const long double braked_from = speed + gain * reaction;
  const long double until_standing = reaction + braked_from / deceleration;
  return human_speed * until_standing +
         0.5L * human_acceleration * until_standing * until_standing + braked_from * reaction +
         0.5L * braked_from * braked_from / deceleration;
}

TEST(ProtectiveDistance, IsWhatPersonAndRobotCoverUntilItStands) {
  Random random(11);
  for (int i = 0; i < 1000; ++i) {
    const double deceleration = random.log_uniform(0.5, 20.0);
    const double reaction = 1e-3 * random.integer(1, 500);
    Separation terms = braking(deceleration, random.uniform(0.1, 3.0), reaction);
    terms.robot_acceleration = random.chance(0.5) ? random.uniform(0.0, 5.0) : 0.0;
    terms.intrusion_distance = random.uniform(0.0, 0.9);
    terms.human_uncertainty = random.uniform(0.0, 0.1);
    terms.robot_uncertainty = random.uniform(0.0, 0.1);
    const Approach approach{.human_speed = random.uniform(0.0, 2.0),
                            .human_acceleration = random.chance(0.5) ? random.unit() : 0.0,
                            .robot_speed = random.uniform(0.0, 2.0)};
    const auto others = static_cast<long double>(terms.intrusion_distance) +
                        terms.human_uncertainty + terms.robot_uncertainty;
    const auto expected = static_cast<double>(
        others + covered(approach.human_speed, approach.human_acceleration, approach.robot_speed,
                         terms.robot_acceleration, reaction, deceleration));
    const ProtectiveDistance found = protective_distance(terms, approach, approach.robot_speed);
    // Stopping times are rounded to whole ns.
    EXPECT_NEAR(found.sum, expected, 1e-6 * expected);
    EXPECT_GE(found.sum, found.human + found.robot + found.stopping);
  }
}

TEST(ProtectiveDistance, CountsInWhatBothHaveCoveredSinceTheirPoses) {
  const Separation terms = braking(4.0, 1.0, 0.1);
  const Approach now{.human_speed = 1.6, .robot_speed = 1.0};
  Approach before = now;
  before.human_age = 0.01;
  before.robot_age = 0.02;
  EXPECT_NEAR(
      protective_distance(terms, before, 1.0).sum - protective_distance(terms, now, 1.0).sum,
      1.6 * 0.01 + 1.0 * 0.02, 1e-12);
  // This distance has already been covered: a robot that is slower from now on does not reduce it.
  EXPECT_NEAR(protective_distance(terms, before, 0.0).robot, 1.0 * 0.02, 1e-12);
}

TEST(ProtectiveDistance, HasStoppingFiguresOfNoSpeedAtAnySpeed) {
  Separation terms = braking(4.0, 1.0, 0.1);
  terms.stopping_speed = 0.0;
  const Approach approach{.human_speed = 1.6, .robot_speed = 0.5};
  EXPECT_NEAR(protective_distance(terms, approach, 0.0).sum, 1.6 * (0.1 + 0.25) + 0.125, 1e-12);
  EXPECT_NEAR(protective_distance(terms, approach, 0.5).sum, 1.6 * (0.1 + 0.25) + 0.05 + 0.125,
              1e-12);
}

TEST(LargestSpeed, IsTheOneOfClosedForm) {
  // 1.6 (0.1 + v / 4) + 0.1 v + v^2 / 8 = 1: v = (-0.5 + sqrt(0.25 + 0.5 * 0.84)) * 4.
  const Separation terms = braking(4.0, 1.0, 0.1);
  const double expected = 4.0 * (-0.5 + std::sqrt(0.25 + 0.5 * 0.84));
  EXPECT_NEAR(largest_speed(terms, {.human_speed = 1.6}, 1.0), expected, 1e-12);
  // The path of a robot that brakes at once, beside a person who stands: v^2 / 8 = 0.5.
  EXPECT_NEAR(largest_speed(braking(4.0, 1.0, 0.0), {.human_speed = 0.0}, 0.5), 2.0, 1e-12);
}

TEST(LargestSpeed, IsNoneWhereAStandingRobotIsTooNear) {
  const Separation terms = braking(4.0, 1.0, 0.1);
  EXPECT_EQ(largest_speed(terms, {.human_speed = 1.6}, 0.159), 0.0);
  EXPECT_EQ(largest_speed(terms, {.human_speed = 1.6}, -1.0), 0.0);
  EXPECT_EQ(largest_speed(terms, {.human_speed = 1.6}, -kInfinity), 0.0);
  EXPECT_GT(largest_speed(terms, {.human_speed = 1.6}, 0.161), 0.0);
}

TEST(LargestSpeed, IsUnboundedWhereSpeedDoesNotMatter) {
  EXPECT_EQ(largest_speed(Separation{}, {.human_speed = 1.6}, 1.0), kInfinity);
}

Separation any_terms(Random& random) {
  Separation terms = braking(random.log_uniform(0.5, 20.0), random.uniform(0.1, 3.0),
                             1e-3 * random.integer(1, 500));
  if (random.chance(0.3)) terms.stopping_speed = 0.0;
  if (random.chance(0.3)) terms.robot_acceleration = random.uniform(0.0, 5.0);
  terms.intrusion_distance = random.uniform(0.0, 0.3);
  terms.human_uncertainty = random.uniform(0.0, 0.1);
  terms.robot_uncertainty = random.uniform(0.0, 0.1);
  return terms;
}

Approach any_approach(Random& random) {
  return {.human_speed = random.uniform(0.0, 2.0),
          .human_acceleration = random.chance(0.5) ? random.unit() : 0.0,
          .robot_speed = random.uniform(0.0, 2.0),
          .human_age = random.uniform(0.0, 0.02),
          .robot_age = random.uniform(0.0, 0.02)};
}

TEST(LargestSpeed, LeavesEnoughAndNotMuchMore) {
  Random random(12);
  int some = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Separation terms = any_terms(random);
    const Approach approach = any_approach(random);
    const double distance =
        protective_distance(terms, approach, 0.0).sum + random.log_uniform(1e-9, 10.0);
    const double speed = largest_speed(terms, approach, distance);
    if (speed == 0.0) {
      // The difference is no more than rounding.
      EXPECT_GT(protective_distance(terms, approach, 1e-4).sum, distance);
      continue;
    }
    ++some;
    ASSERT_LE(protective_distance(terms, approach, speed).sum, distance);
    ASSERT_LE(protective_distance(terms, approach, speed * random.unit()).sum, distance);
    ASSERT_GT(protective_distance(terms, approach, speed * (1.0 + 1e-9) + 1e-9).sum, distance);
  }
  EXPECT_GT(some, 19'000);
}

// Rounding decides if the distance is hardly more than that of a robot that stands.
TEST(LargestSpeed, LeavesEnoughAtTheDistanceOfARobotThatStands) {
  Random random(14);
  int none = 0, some = 0;
  for (int i = 0; i < 2'000; ++i) {
    const Separation terms = any_terms(random);
    const Approach approach = any_approach(random);
    double distance = protective_distance(terms, approach, 0.0).sum;
    for (int step = 0; step < 8; ++step) {
      const double speed = largest_speed(terms, approach, distance);
      ASSERT_LE(protective_distance(terms, approach, speed).sum, distance);
      ASSERT_LT(speed, 1e-10);
      ++(speed > 0.0 ? some : none);
      distance = std::nextafter(distance, kInfinity);
    }
  }
  EXPECT_GT(none, 100);
  EXPECT_GT(some, 100);
}

// A worse term never allows a higher speed.
TEST(LargestSpeed, NeverGrowsWithATermThatGrows) {
  Random random(13);
  for (int i = 0; i < 2000; ++i) {
    const Separation terms = any_terms(random);
    const Approach approach = any_approach(random);
    const double distance = random.uniform(0.2, 4.0);
    const double speed = largest_speed(terms, approach, distance);
    const auto expect_no_more = [&](const Separation& worse, const Approach& faster) {
      ASSERT_LE(largest_speed(worse, faster, distance), speed);
    };
    for (std::int64_t Separation::*time :
         {&Separation::reaction_time_ns, &Separation::stopping_time_ns}) {
      Separation worse = terms;
      worse.*time += 1'000'000 * random.integer(1, 100);
      expect_no_more(worse, approach);
    }
    for (double Separation::*term :
         {&Separation::stopping_distance, &Separation::robot_acceleration,
          &Separation::intrusion_distance, &Separation::human_uncertainty,
          &Separation::robot_uncertainty}) {
      Separation worse = terms;
      worse.*term += random.uniform(1e-3, 0.5);
      expect_no_more(worse, approach);
    }
    for (double Approach::*term : {&Approach::human_speed, &Approach::human_acceleration,
                                   &Approach::human_age, &Approach::robot_age}) {
      Approach worse = approach;
      worse.*term += random.uniform(1e-3, 0.5);
      expect_no_more(terms, worse);
    }
    ASSERT_LE(largest_speed(terms, approach, distance - 1e-3), speed);
  }
}

}  // namespace
}  // namespace clearance
