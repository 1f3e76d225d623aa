// Zones with `separation` in the tick: two balls, one of them a person and the other a robot.
#include "monitor/zones/separations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "monitor/zones/protective_distance.hpp"
#include "tests/monitor/replay/report_bytes.hpp"
#include "tests/monitor/tick/small_cells.hpp"
#include "tests/monitor/zones/meeting.hpp"
#include "tests/shared/allocation_count.hpp"

namespace clearance {
namespace {

using test::Meeting, test::usual_terms, test::kHumanRadius, test::kRobotRadius;

void expect_no_limit_without(std::uint32_t absent) {
  Meeting cell;
  ASSERT_LT(cell.tick(0.4, 0.0, 1.0).scaling, 1.0);
  ASSERT_TRUE(cell.monitor->set_absent(absent, true));
  const PairSeparation& pair = cell.tick(0.4, 0.0, 1.0);
  EXPECT_EQ(pair.validity, SeparationValidity::kAbsent);
  EXPECT_EQ(pair.scaling, 1.0);
  EXPECT_EQ(pair.speed_limit, kInfinity);
  EXPECT_EQ(pair.remaining, -kInfinity);
  EXPECT_TRUE(std::isnan(pair.protective_distance));
  const ZoneSeparation& zone = cell.report->separated_zones[0];
  EXPECT_EQ(zone.validity, SeparationValidity::kAbsent);
  EXPECT_EQ(zone.scaling, 1.0);
  EXPECT_EQ(zone.remaining, kInfinity);

  cell.monitor->set_absent(absent, false);
  EXPECT_EQ(cell.wait(test::kTick).validity, SeparationValidity::kUnknown) << "until the next pose";
  EXPECT_EQ(cell.report->separated_zones[0].scaling, 0.0);
  EXPECT_EQ(cell.tick(0.4, 0.0, 1.0).validity, SeparationValidity::kMeasured);
}

TEST(Separations, APersonOrARobotThatIsKnownNotToBeThereLimitsNothing) {
  for (const std::uint32_t absent : {0U, 1U}) expect_no_limit_without(absent);
}

TEST(Separation, OfARobotThatApproachesHasTheTermsOfTheStandard) {
  Meeting meeting;
  const PairSeparation& pair = meeting.tick(2.0, 0.0, 0.8);
  EXPECT_EQ(pair.validity, SeparationValidity::kMeasured);
  EXPECT_NEAR(pair.clearance, 2.0 - kHumanRadius - kRobotRadius, 1e-12);
  EXPECT_EQ(pair.human_speed, 1.6);
  EXPECT_NEAR(pair.robot_speed, 0.8, 1e-12);
  EXPECT_NEAR(pair.human_term, 1.6 * (0.1 + 0.2), 1e-12);
  EXPECT_NEAR(pair.robot_term, 0.8 * 0.1, 1e-12);
  EXPECT_NEAR(pair.stopping_term, 0.08, 1e-12);
  EXPECT_NEAR(pair.protective_distance, 0.64, 1e-12);
  EXPECT_NEAR(pair.remaining, 1.7 - 0.64, 1e-12);
  EXPECT_EQ(pair.scaling, 1.0);
  EXPECT_GT(pair.speed_limit, 0.8);
}

TEST(Separation, OfARobotThatStandsOrRecedesIsThePersonsPathAlone) {
  for (const double speed : {0.0, -0.5}) {
    Meeting meeting;
    const PairSeparation& pair = meeting.tick(2.0, 0.0, speed);
    EXPECT_EQ(pair.robot_speed, 0.0);
    EXPECT_NEAR(pair.protective_distance, 0.16, 1e-12);
    EXPECT_EQ(pair.scaling, 1.0);
    EXPECT_EQ(meeting.tick(0.45, 0.0, speed).scaling, 0.0);  // 0.15 m apart
  }
}

TEST(Separation, TooNearScalesToWhatKeepsTheDistance) {
  Meeting meeting;
  const PairSeparation near = meeting.tick(0.8, 0.0, 1.0);  // 0.5 m apart
  EXPECT_LT(near.remaining, 0.0);
  // 0.16 + 0.5 v + v^2 / 8 = 0.5
  const double expected = 4.0 * (-0.5 + std::sqrt(0.25 + 0.5 * 0.34));
  EXPECT_NEAR(near.speed_limit, expected, 1e-12);
  EXPECT_NEAR(near.scaling, expected, 1e-12);
  EXPECT_GE(meeting.tick(0.8, 0.0, near.scaling * 1.0).remaining, -1e-12);
}

TEST(Separation, OfARobotThatTurnsCountsItsFastestPoint) {
  Meeting meeting;
  meeting.robot_turn = {0, 0, 3.0};
  EXPECT_NEAR(meeting.tick(2.0, 0.0, 0.5).robot_speed, 0.5 + 3.0 * kRobotRadius, 1e-12);
  // The robot rotates about the line to the person, so it does not approach.
  meeting.robot_turn = {3.0, 0, 0};
  EXPECT_NEAR(meeting.tick(2.0, 0.0, 0.5).robot_speed, 0.5, 1e-12);
}

TEST(Separation, HasTheSameFiguresWhicheverObjectIsThePerson) {
  Meeting first, second;
  std::swap(second.scene.objects[0], second.scene.objects[1]);
  second.scene.zones[0].separation->human_is_first = {0};
  second.begin();
  const PairSeparation& expected = first.tick(1.0, 0.0, 0.7);
  PoseSample robot = test::sample(0, test::at(0, 0, 0), second.now), person = robot;
  robot.has_twist = person.has_twist = true;
  robot.twist.linear = {0.7, 0, 0};
  person.object = 1;
  person.world_from_object = test::at(1.0, 0, 0);
  const PoseSample both[] = {robot, person};
  const PairSeparation& found = second.monitor->tick(both, second.now).separated_pairs[0];
  EXPECT_NEAR(found.remaining, expected.remaining, 1e-12);
  EXPECT_NEAR(found.scaling, expected.scaling, 1e-12);
  EXPECT_NEAR(found.robot_speed, expected.robot_speed, 1e-12);
}

TEST(Separation, CountsInMarginsAndTheAgesOfPosesInUse) {
  Meeting meeting;
  meeting.scene.objects[0].margin = 0.03;
  const PairSeparation& pair = meeting.tick(2.0, 0.0, 0.8, 10'000'000, 5'000'000);
  EXPECT_NEAR(pair.clearance, 1.67, 1e-12);
  EXPECT_NEAR(pair.protective_distance, 0.64 + 1.6 * 0.01 + 0.8 * 0.005, 1e-12);
  EXPECT_EQ(pair.age_human_ns, 10'000'000);
  EXPECT_EQ(pair.age_robot_ns, 5'000'000);
}

TEST(Separation, WithAMeasuredPersonUsesHisSpeedAndThatHeMayBeginToRun) {
  Separation terms = usual_terms();
  terms.human_speed_is_measured = true;
  terms.human_acceleration = 1.0;
  Meeting meeting(terms);
  EXPECT_NEAR(meeting.tick(2.0, -0.5, 0.0).human_term, 0.5 * 0.1 + 0.5 * 0.01, 1e-12);
  EXPECT_EQ(meeting.tick(2.0, 0.5, 0.0).human_speed, 0.0);
  EXPECT_EQ(meeting.report->separated_pairs[0].validity, SeparationValidity::kMeasured);
  // The pose is late, which is treated as if the person had not been measured.
  meeting.scene.objects[0].max_speed = 3.0;
  EXPECT_EQ(meeting.wait(25'000'000).human_speed, 1.6);
}

TEST(Separation, OfALateRobotHasItsLargestSpeedAndSaysSo) {
  Meeting meeting;
  meeting.scene.objects[0].age_limit_ns = 1'000'000'000;
  meeting.tick(2.0, 0.0, 0.1);
  const PairSeparation& pair = meeting.wait(30'000'000);
  EXPECT_EQ(pair.validity, SeparationValidity::kAssumed);
  EXPECT_EQ(pair.robot_speed, 2.0);
  EXPECT_NEAR(pair.clearance, 1.7 - 2.0 * 0.03, 1e-12);
  EXPECT_NEAR(pair.protective_distance, 1.6 * (0.03 + 0.1 + 0.5) + 0.2 + 0.5, 1e-9);
  EXPECT_EQ(pair.age_robot_ns, 30'000'000);
  EXPECT_EQ(meeting.report->separated_zones[0].validity, SeparationValidity::kAssumed);
}

TEST(Separation, OfALatePersonCountsTheLargerOfTheMeasuredAndTheStatedSpeed) {
  Separation terms = usual_terms();
  terms.human_speed_is_measured = true;
  terms.human_acceleration = 0.1;
  Meeting meeting(terms);
  meeting.scene.objects[0].max_speed = 3.0;
  const double measured = meeting.tick(2.0, -2.5, 0.5).human_speed;
  EXPECT_NEAR(measured, 2.5, 1e-12);
  EXPECT_EQ(meeting.wait(25'000'000).human_speed, measured);
  EXPECT_EQ(meeting.report->separated_pairs[0].validity, SeparationValidity::kAssumed);
}

TEST(Separation, OfALateRobotCountsTheLargerOfTheMeasuredAndTheStatedSpeed) {
  Separation terms = usual_terms();
  terms.robot_speed = 0.25;
  Meeting meeting(terms);
  meeting.scene.objects[0].age_limit_ns = 1'000'000'000;
  const double measured = meeting.tick(2.0, 0.0, 1.0).robot_speed;
  EXPECT_NEAR(measured, 1.0, 1e-12);
  EXPECT_EQ(meeting.wait(30'000'000).robot_speed, measured);
}

// A person and a robot with random motions and stated figures, seen once.
std::unique_ptr<Meeting> random_meeting(Random& random) {
  Separation terms = usual_terms();
  terms.human_speed = random.uniform(0.2, 2.5);
  terms.human_speed_is_measured = random.chance(0.7);
  if (terms.human_speed_is_measured) terms.human_acceleration = random.uniform(0.0, 3.0);
  if (random.chance(0.5)) terms.robot_speed = random.uniform(0.1, 2.0);
  if (random.chance(0.2)) terms.stopping_speed = 0.0;
  if (random.chance(0.3)) terms.robot_acceleration = random.uniform(0.0, 3.0);
  const double robot_max_speed = random.uniform(0.3, 3.0), max_speed = random.uniform(0.3, 4.0);
  auto made = std::make_unique<Meeting>(terms, robot_max_speed);
  Meeting& meeting = *made;
  meeting.scene.evaluate_all = true;
  meeting.scene.objects[0].max_speed = max_speed;
  for (Object& object : meeting.scene.objects)
    object.age_limit_ns = 1'000'000 * random.integer(8, 60);
  if (random.chance(0.5)) meeting.robot_turn = random.uniform(0.0, 3.0) * random.direction();
  meeting.tick(random.uniform(0.5, 4.0), max_speed * random.uniform(-1.4, 0.5),
               robot_max_speed * random.uniform(-0.5, 1.4));
  return made;
}

TEST(Separation, NeverAllowsMoreBecauseAPoseBecomesOlder) {
  constexpr double kRounding = 1e-12;
  Random random(23);
  int late = 0, slower = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const std::unique_ptr<Meeting> made = random_meeting(random);
    Meeting& meeting = *made;
    PairSeparation before = meeting.report->separated_pairs[0];
    for (int step = 0; step < 25; ++step) {
      const PairSeparation now = meeting.wait(1'000'000 * random.integer(1, 9));
      ASSERT_LE(now.speed_limit, before.speed_limit + kRounding) << trial << ", " << step;
      ASSERT_LE(now.remaining, before.remaining + kRounding) << trial << ", " << step;
      ASSERT_LE(now.scaling, before.scaling + kRounding) << trial << ", " << step;
      late += now.validity == SeparationValidity::kAssumed;
      slower += now.speed_limit < before.speed_limit;
      before = now;
    }
  }
  EXPECT_GT(late, 10'000);
  EXPECT_GT(slower, 3'000);
}

void expect_unknown(const Report& report) {
  const PairSeparation& pair = report.separated_pairs[0];
  EXPECT_EQ(pair.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(pair.scaling, 0.0);
  EXPECT_EQ(pair.speed_limit, 0.0);
  EXPECT_EQ(pair.remaining, -kInfinity);
  EXPECT_TRUE(std::isnan(pair.protective_distance));
  const ZoneSeparation& zone = report.separated_zones[0];
  EXPECT_EQ(zone.validity, SeparationValidity::kUnknown);
  EXPECT_EQ(zone.scaling, 0.0);
  EXPECT_EQ(zone.speed_limit, 0.0);
  EXPECT_EQ(zone.remaining, -kInfinity);
}

TEST(Separation, IsUnknownAndScalesToNothingBeforeEveryPoseHasCome) {
  Meeting meeting;
  meeting.begin();
  meeting.wait(test::kTick);
  expect_unknown(*meeting.report);
  EXPECT_EQ(meeting.report->separated_pairs[0].age_robot_ns, -1);
  const PoseSample robot = test::sample(1, test::at(0, 0, 0), meeting.now);
  expect_unknown(meeting.monitor->tick({&robot, 1}, meeting.now));
}

TEST(Separation, IsUnknownWhereNothingBoundsTheSpeedOfALateRobot) {
  Meeting meeting(usual_terms(), kInfinity);
  EXPECT_EQ(meeting.tick(2.0, 0.0, 0.1).validity, SeparationValidity::kMeasured);
  meeting.wait(30'000'000);
  expect_unknown(*meeting.report);
}

// The pose is known, but the velocity is not: it is a first pose without a twist.
TEST(Separation, OfAnUnknownSpeedHasTheOneThatTheZoneStatesOrIsUnknown) {
  for (const double stated : {0.25, kInfinity}) {
    Separation terms = usual_terms();
    terms.robot_speed = stated;
    Meeting meeting(terms, kInfinity);
    meeting.begin();
    const PoseSample both[] = {test::sample(0, test::at(2, 0, 0), meeting.now),
                               test::sample(1, test::at(0, 0, 0), meeting.now)};
    const Report& report = meeting.monitor->tick(both, meeting.now);
    if (stated == kInfinity) {
      expect_unknown(report);
      continue;
    }
    EXPECT_EQ(report.separated_pairs[0].validity, SeparationValidity::kAssumed);
    EXPECT_EQ(report.separated_pairs[0].robot_speed, stated);
  }
}

TEST(Separation, IsUnknownWhereNoBoundOfTheDistanceIs) {
  Separation terms = usual_terms();
  terms.human_is_first = {1};
  Scene scene = test::cell_of({test::moving("person", {test::floor()}),
                               test::fixed("robot", {test::floor()}, test::at(0, 0, 0))});
  scene.pairs[0].publish = true;
  scene.zones.push_back(test::zone_over(scene, 0.3, 0.4));
  scene.zones[0].separation = terms;
  Monitor monitor(scene);
  PoseSample person = test::sample(0, test::at(0, 0, 0), test::kStart);
  person.has_twist = true;
  const Report& report = monitor.tick({&person, 1}, test::kStart);
  ASSERT_NE(report.pairs[0].status, PairStatus::kUnknown);
  ASSERT_EQ(report.pairs[0].lower, -kInfinity);
  expect_unknown(report);
}

TEST(Separation, OfAZoneIsTheLeastOfItsPairs) {
  Scene scene = test::cell_of({test::moving("near", {test::ball(0.1)}),
                               test::moving("far", {test::ball(0.1)}),
                               test::moving("robot", {test::ball(0.1)})});
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  Zone zone{"people", "people", "robot", 0.1, 0.2, {1, 2}};  // pairs near - robot, far - robot
  zone.separation = usual_terms();
  zone.separation->human_is_first = {1, 1};
  scene.zones = {zone};
  Monitor monitor(scene);
  std::vector<PoseSample> samples;
  for (const double x : {0.7, 3.0, 0.0}) {
    samples.push_back(
        test::sample(static_cast<std::uint32_t>(samples.size()), test::at(x, 0, 0), test::kStart));
    samples.back().has_twist = true;
  }
  samples[2].twist.linear = {1.0, 0, 0};
  const Report& report = monitor.tick(samples, test::kStart);
  ASSERT_EQ(report.separated_zones.size(), 1u);
  ASSERT_EQ(report.separated_pairs.size(), 2u);
  EXPECT_EQ(report.separated_pairs[1].scaling, 1.0);
  EXPECT_LT(report.separated_pairs[0].scaling, 1.0);
  EXPECT_EQ(report.separated_zones[0].pair, 1u);
  EXPECT_EQ(report.separated_zones[0].scaling, report.separated_pairs[0].scaling);
  EXPECT_EQ(report.separated_zones[0].remaining, report.separated_pairs[0].remaining);
  EXPECT_EQ(report.separated_zones[0].speed_limit, report.separated_pairs[0].speed_limit);
}

// A person and a robot of two parts, with arbitrary rotations and translations.
class Dance {
 public:
  explicit Dance(std::uint64_t seed) : random_(seed) {
    meeting.scene.objects[1].parts.push_back(test::capsule(0.8, 0.05));
    meeting.begin();
  }
  const Report& next() {
    std::vector<PoseSample> samples;
    for (std::uint32_t object = 0; object < 2; ++object) {
      if (random_.chance(0.1)) continue;
      const Pose pose = random_.pose(1.5);
      samples.push_back(test::sample(object, pose, meeting.now += test::kTick));
      samples.back().has_twist = random_.chance(0.8);
      samples.back().twist = {random_.uniform(0.0, 2.0) * random_.direction(),
                              random_.uniform(0.0, 3.0) * random_.direction()};
    }
    const std::uint64_t before = allocations();
    const Report& report = meeting.monitor->tick(samples, meeting.now);
    allocated += allocations() - before;
    return report;
  }

  Meeting meeting;
  std::uint64_t allocated = 0;

 private:
  Random random_;
};

TEST(Separation, KeepsTheDistanceWithTheRobotAsSlowAsItsScaling) {
  Dance dance(21);
  int slowed = 0;
  for (int t = 0; t < 3000; ++t) {
    const PairSeparation& pair = dance.next().separated_pairs[0];
    ASSERT_GE(pair.scaling, 0.0);
    ASSERT_LE(pair.scaling, 1.0);
    ASSERT_EQ(pair.scaling == 1.0, pair.remaining >= 0.0) << t;
    if (pair.scaling == 0.0) continue;
    slowed += pair.scaling < 1.0;
    const Approach approach{.human_speed = pair.human_speed,
                            .robot_speed = pair.robot_speed,
                            .human_age = 1e-9 * static_cast<double>(pair.age_human_ns),
                            .robot_age = 1e-9 * static_cast<double>(pair.age_robot_ns)};
    if (pair.validity != SeparationValidity::kMeasured) continue;
    ASSERT_LE(protective_distance(*dance.meeting.scene.zones[0].separation, approach,
                                  pair.scaling * pair.robot_speed)
                  .sum,
              pair.clearance + 1e-12);
  }
  EXPECT_GT(slowed, 100);
}

TEST(Separation, AllocatesNothingAndGivesTheSameBitsAgain) {
  Dance first(22), second(22);
  for (int t = 0; t < 300; ++t) {
    const std::vector<unsigned char> expected = test::bytes_of(first.next());
    ASSERT_EQ(test::bytes_of(second.next()), expected) << t;
  }
  EXPECT_EQ(first.allocated, 0u);
}

}  // namespace
}  // namespace clearance
