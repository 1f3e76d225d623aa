// Scene::response_limit_ns: an input whose age and the report's delay exceed it is unknown, and
// known again as soon as they do not.
//
// Oracle: age + delay <= limit, and age <= age limit, in whole ns.
#include <gtest/gtest.h>

#include "tests/monitor/replay/report_bytes.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/two_balls.hpp"

namespace clearance::test {
namespace {

constexpr std::int64_t kLimit = 15 * kTick;  // the age limit of the ball is 20 ticks

// A ball that states a speed: by age alone, its bounds would get wider and stay known.
Scene limited_balls(std::int64_t limit_ns = kLimit) {
  Scene scene = balls_of_speed(2.0);
  scene.zones.push_back(zone_over(scene, 0.1, 0.2));
  scene.response_limit_ns = limit_ns;
  return scene;
}

TickTime told(std::int64_t now_ns, std::int64_t delay_ns) { return {now_ns, 0, delay_ns}; }

void expect_unknown(const Report& report) {
  EXPECT_EQ(report.pairs[0].status, PairStatus::kUnknown);
  EXPECT_EQ(report.pairs[0].lower, -kInfinity);
  EXPECT_EQ(report.lower_all, -kInfinity);
  EXPECT_FALSE(report.minimum_certified);
  EXPECT_TRUE(report.zones[0].active);
  EXPECT_EQ(report.zones[0].cause, ZoneCause::kLate);
}

TEST(ResponseLimit, AnInputBeyondItIsUnknownAndNoOther) {
  const Scene scene = limited_balls();
  Monitor monitor(scene);
  Random random(62);
  std::int64_t now = kStart, stamp = 0;
  int beyond = 0;
  for (int i = 0; i < 5000; ++i) {
    now += random.integer(1, 5) * kTick;
    const std::int64_t delay = random.integer(0, 16) * kTick + random.integer(-1, 1);
    const TickTime time = told(now, std::max<std::int64_t>(0, delay));
    const PoseSample moved = sample(0, at(0.01 * random.unit(), 0, 0), now);
    const bool sends = stamp == 0 || random.chance(0.2);
    if (sends) stamp = now;
    const Report& report = monitor.tick(std::span(&moved, sends ? 1 : 0), time);
    ASSERT_EQ(report.report_delay_ns, time.report_delay_ns);
    const std::int64_t age = now - stamp;
    if (age + time.report_delay_ns > kLimit) {
      ++beyond;
      expect_unknown(report);
      EXPECT_EQ(monitor.present_pose(0).state, PresentPose::State::kLate);
    } else {
      EXPECT_NE(report.pairs[0].status, PairStatus::kUnknown);
      EXPECT_FALSE(report.zones[0].active) << "0.8 m apart";
    }
    EXPECT_EQ(monitor.response_is_late(), age + time.report_delay_ns > kLimit && age <= 20 * kTick);
    if (HasFailure()) FAIL() << "tick " << i;
  }
  EXPECT_GT(beyond, 1000);
  EXPECT_LT(beyond, 4000);
}

// An object at rest is visited only when it is late: a longer delay makes it so.
TEST(ResponseLimit, AlsoHoldsForObjectsThatRest) {
  const Scene scene = limited_balls();
  Monitor monitor(scene);
  std::int64_t now = kStart;
  const auto tick = [&](std::int64_t delay_ns) -> const Report& {
    now += kTick;
    const PoseSample rests = with_twist(at(0, 0, 0), Vec3::Zero(), now);
    return monitor.tick(std::span(&rests, 1), told(now, delay_ns));
  };
  for (int i = 0; i < 100; ++i) ASSERT_NE(tick(kTick).pairs[0].status, PairStatus::kUnknown);
  expect_unknown(tick(kLimit + 1));
  expect_unknown(tick(kLimit + 1));
  EXPECT_NE(tick(kLimit).pairs[0].status, PairStatus::kUnknown);
  // Once it is silent, it is late when age and delay exceed the limit, not before.
  for (int i = 1; i < 12; ++i) {
    now += kTick;
    const Report& report = monitor.tick({}, told(now, 5 * kTick));
    EXPECT_EQ(report.pairs[0].status == PairStatus::kUnknown, i > 10) << i;
  }
}

TEST(ResponseLimit, NothingIsKnownBeforeAReportWasMeasured) {
  const Scene scene = limited_balls();
  Monitor monitor(scene);
  const PoseSample first = sample(0, at(0, 0, 0), kStart);
  expect_unknown(monitor.tick(std::span(&first, 1), told(kStart, TickTime::kNotMeasured)));
  EXPECT_FALSE(monitor.response_is_late()) << "that is no fault yet";
  const Report& next = monitor.tick({}, told(kStart + kTick, kTick));
  EXPECT_NE(next.pairs[0].status, PairStatus::kUnknown);
}

TEST(ResponseLimit, WithoutItADelayChangesNothingButWhatTheReportSaysOfIt) {
  const Scene scene = limited_balls(Scene::kNoLimit);
  Monitor told_one(scene), other(scene);
  for (int i = 1; i < 60; ++i) {
    const std::int64_t now = kStart + i * kTick;
    const PoseSample moved = sample(0, at(0.001 * i, 0, 0), now);
    const std::span<const PoseSample> samples(&moved, i % 7 == 0 ? 1 : 0);
    Report report = told_one.tick(samples, told(now, i % 2 == 0 ? 1000 * kTick : -1));
    report.report_delay_ns = 0;
    ASSERT_EQ(bytes_of(report), bytes_of(other.tick(samples, now))) << i;
  }
}

TEST(ResponseLimit, TheLinksOfARobotAreUnknownWithTheirJoints) {
  Scene scene = scara_cell();
  scene.response_limit_ns = kLimit;
  for (ObjectPair& pair : scene.pairs) pair.publish = true;
  Monitor monitor(scene);
  std::int64_t now = kStart;
  const auto tick = [&](std::int64_t delay_ns) -> const Report& {
    now += kTick;
    return monitor.tick({}, joints(0.1, 0.2, 0.1, now), told(now, delay_ns));
  };
  const auto unknown = [](const Report& report) {
    return std::ranges::count(report.pairs, PairStatus::kUnknown, &PairReport::status);
  };
  for (int i = 0; i < 3; ++i) tick(kLimit);
  const auto without_the_cart = unknown(tick(kLimit));
  ASSERT_LT(without_the_cart, std::ssize(scene.pairs));
  const Report& late = tick(kLimit + 1);
  EXPECT_EQ(unknown(late), std::ssize(scene.pairs));
  EXPECT_TRUE(late.zones[0].active);
  EXPECT_TRUE(monitor.response_is_late());
  EXPECT_EQ(monitor.present_joint(0).state, PresentPose::State::kLate);
  EXPECT_EQ(unknown(tick(kLimit)), without_the_cart);
  EXPECT_FALSE(monitor.response_is_late());
}

}  // namespace
}  // namespace clearance::test
