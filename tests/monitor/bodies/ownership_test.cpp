// Sources that may send an object's pose, tested through the tick.
#include <gtest/gtest.h>

#include "config/scene/source_name.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/intake/pose_sources.hpp"
#include "tests/monitor/tick/two_balls.hpp"

namespace clearance {
namespace {

using test::kStart;
using test::kTick;
using test::rejected;

PoseSample from(std::uint32_t source, double x, std::int64_t stamp_ns) {
  PoseSample sample = test::sample(0, test::at(x, 0, 0), stamp_ns);
  sample.source = source;
  return sample;
}

TEST(Ownership, FirstSourceOfAnObjectKeepsItWhileAnotherSendsTheSame) {
  const Scene scene = test::two_balls();
  Monitor monitor(scene);
  for (int tick = 0; tick < 500; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const std::array samples{from(3, 0.0, now), from(5, 0.001, now + 4'500'000)};
    const Report& report = monitor.tick(samples, now);
    ASSERT_NEAR(report.minimum.distance, 0.8, 1e-12);
    ASSERT_TRUE(report.minimum_certified);
  }
  EXPECT_EQ(rejected(monitor, Reject::kOtherSource), 500u);
  EXPECT_EQ(monitor.input_age(0).source, 3u);
  EXPECT_EQ(monitor.input_age(0).other_source, 5u);
}

// A source that comes back later is news again.
TEST(Ownership, ASourceThatIsNotUsedIsToldUntilItWasSilentForTenSeconds) {
  const Scene scene = test::two_balls();
  Monitor monitor(scene);
  std::int64_t now = kStart;
  const std::array both{from(3, 0.0, now), from(5, 0.0, now)};
  monitor.tick(both, now);
  const auto other_after = [&](std::int64_t ns) {
    for (const std::int64_t end = kStart + ns; now < end;) {
      now += 100 * kTick;
      const PoseSample sample = from(3, 0.0, now);
      monitor.tick(std::span(&sample, 1), now);
    }
    return monitor.input_age(0).other_source;
  };
  EXPECT_EQ(other_after(kOtherGoneNs), 5u);
  EXPECT_EQ(other_after(kOtherGoneNs + 100 * kTick), kNoSource);
  const PoseSample again = from(5, 0.0, now);
  monitor.tick(std::span(&again, 1), now + kTick);
  EXPECT_EQ(monitor.input_age(0).other_source, 5u);
}

// Whoever came first: which of the two is right cannot be told.
TEST(Ownership, ObjectOfTwoSourcesThatContradictIsUnknownUntilASecondAfter) {
  const Scene scene = test::two_balls();
  Monitor monitor(scene);
  for (int tick = 0; tick < 500; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const std::array samples{from(3, 0.0, now), from(5, 0.5, now)};
    const Report& report = monitor.tick(samples, now);
    ASSERT_EQ(report.pairs[0].status, PairStatus::kUnknown);
    ASSERT_FALSE(report.minimum_certified);
  }
  for (int tick = 500; tick <= 1500; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const PoseSample sample = from(3, 0.0, now);
    const Report& report = monitor.tick(std::span(&sample, 1), now);
    ASSERT_EQ(report.pairs[0].status == PairStatus::kConverged, tick >= 1500) << tick;
  }
}

// The cell names a source, and two writers have that name. It does not say which of them is meant.
TEST(Ownership, ObjectOfTwoWritersWithTheNameThatTheCellStatesIsUnknownWhileTheyContradict) {
  const std::string longest = "/left/of/all/cells/joint_states_";
  ASSERT_EQ(longest.size(), kMaxSourceLength);
  struct Case {
    std::string stated;
    SourceName other;
    bool is_namesake;
  };
  for (const auto& [stated, other, is_namesake] : {
           Case{"tracker", name_of_writer("tracker", 2), true},
           Case{"tracker", name_of_writer("tracker", 12), true},
           Case{base_source("/tf"), SourceName(base_source("/tf#2")), true},
           Case{longest, name_of_writer(longest, 2), true},
           Case{longest, name_of_writer(longest, 10), true},
           Case{longest, name_of_writer("/a/namespace" + longest, 2), true},
           Case{longest, name_of_writer("/right" + longest.substr(5), 2), false},
           Case{longest, name_of_writer(longest.substr(0, 31), 2), false},
           Case{"tracker", SourceName("other#2"), false},
           Case{"tracker", SourceName("my_tracker#2"), false},
           Case{"tracker", SourceName("tracker#"), false},
           Case{"tracker", SourceName("#" + std::string(kMaxSourceLength - 1, '2')), false},
           Case{"tracker", SourceName("tracker#two"), false},
       }) {
    SCOPED_TRACE(other.view());
    Scene scene = test::two_balls();
    scene.objects[0].source = stated;
    Monitor monitor(scene);
    SourceNumbers numbers(scene);
    for (int tick = 0; tick < 100; ++tick) {
      const std::int64_t now = kStart + tick * kTick;
      std::vector<PoseSample> samples;
      std::vector<JointSample> joints;
      PoseBatch batch;
      batch.source = SourceName(stated);
      batch.samples = {from(0, 0.0, now)};
      numbers.append(batch, samples, joints);
      batch.source = other;
      batch.samples = {from(0, 0.5, now)};
      numbers.append(batch, samples, joints);
      const Report& report = monitor.tick(samples, now);
      ASSERT_EQ(report.pairs[0].status == PairStatus::kUnknown, is_namesake);
    }
    EXPECT_EQ(rejected(monitor, Reject::kDisputed), is_namesake ? 100u : 0u);
  }
}

TEST(Ownership, AnotherSourceTakesOverAfterASecondOfSilence) {
  const Scene scene = test::two_balls();
  Monitor monitor(scene);
  const PoseSample first = from(3, 0.0, kStart);
  monitor.tick(std::span(&first, 1), kStart);
  for (int tick = 1; tick <= 1001; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const PoseSample sample = from(5, 0.001, now);
    const Report& report = monitor.tick(std::span(&sample, 1), now);
    ASSERT_EQ(report.pairs[0].status, tick <= 20     ? PairStatus::kConverged
                                      : tick <= 1000 ? PairStatus::kUnknown
                                                     : PairStatus::kConverged)
        << tick;
  }
  EXPECT_EQ(monitor.input_age(0).source, 5u);
  EXPECT_EQ(monitor.input_age(0).takeovers, 1u);
  EXPECT_EQ(monitor.input_age(0).former_source, 3u);
}

// An owner that sends what cannot be is refused, but it is not silent.
TEST(Ownership, SourceThatIsRefusedLosesNothingToARival) {
  Scene scene = test::two_balls();
  scene.objects[0].may_jump = false;
  scene.objects[0].max_speed = 0.1;
  Monitor monitor(scene);
  for (int tick = 0; tick <= 3000; ++tick) {
    const std::int64_t now = kStart + tick * kTick;
    const double owners = tick > 0 && tick < 2500 ? 3.0 : 0.0;
    const std::array samples{from(3, owners, now), from(5, 0.0, now)};
    monitor.tick(samples, now);
    ASSERT_EQ(monitor.input_age(0).source, 3u) << tick;
  }
  EXPECT_FALSE(monitor.input_age(0).stale) << "it is right again";
}

TEST(Ownership, SourceThatTheCellNamesIsTheOnlyOne) {
  Scene scene = test::two_balls();
  scene.objects[0].source = "arm";
  SourceNumbers numbers(scene);
  Monitor monitor(scene);
  const PoseSample other = from(numbers.of(SourceName("other")), 0.0, kStart);
  EXPECT_EQ(monitor.tick(std::span(&other, 1), kStart).unknown, 1u);
  const PoseSample own = from(numbers.of(SourceName("arm")), 0.1, kStart);
  EXPECT_NEAR(monitor.tick(std::span(&own, 1), kStart).minimum.distance, 0.7, 1e-12);
  const std::int64_t later = kStart + 5000 * kTick;
  const PoseSample again = from(other.source, 0.0, later);
  EXPECT_EQ(monitor.tick(std::span(&again, 1), later).unknown, 1u);
  EXPECT_EQ(rejected(monitor, Reject::kOtherSource), 2u);
}

TEST(SourceNumbers, OneBeyondThePlacesTakesThatOfTheOneHeardLongestAgo) {
  Scene scene = test::two_balls();
  scene.objects[0].source = "named";
  SourceNumbers numbers(scene);
  for (std::size_t i = 1; i < kMaxSources; ++i) {
    EXPECT_EQ(numbers.of(SourceName("s" + std::to_string(i))), i);
  }
  EXPECT_EQ(numbers.of(SourceName("s1")), 1u);
  EXPECT_EQ(numbers.of(SourceName("late")), 2u);
  EXPECT_EQ(numbers.name(2).view(), "late");
  EXPECT_EQ(numbers.of(SourceName("named")), 0u) << "is never replaced";
  EXPECT_EQ(numbers.name(kNoSource).view(), "");
}

}  // namespace
}  // namespace clearance
