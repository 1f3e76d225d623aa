// When the figures of clearance-plc count, by a clock of this test.
#include "tools/plc/held_figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include "tests/shared/random.hpp"

namespace clearance::plc {
namespace {

constexpr std::int64_t kMs = 1'000'000, kPeriod = 10 * kMs, kStep = kPeriod / 4;

class PlcFigures : public testing::Test {
 protected:
  void report(double value) { figures.add(MessageKind::kDistances, {&value, 1}, now + kPeriod); }
  Cause step(std::int64_t after = kStep) {
    figures.step(now += after);
    return figures.cause();
  }
  [[nodiscard]] double value() const { return figures.values()[0]; }

  HeldFigures figures{1, kPeriod};
  std::int64_t now = 5'000 * kMs;
};

TEST_F(PlcFigures, AreFailSafeUntilTheFirstReport) {
  EXPECT_EQ(step(), Cause::kNothingHeard);
  EXPECT_EQ(value(), -kInfinite);
  EXPECT_EQ(figures.heartbeat(), 0);
  report(2.0);
  EXPECT_EQ(step(), Cause::kNone);
  EXPECT_EQ(value(), 2.0);
  EXPECT_EQ(figures.heartbeat(), 1);
}

TEST_F(PlcFigures, AreFailSafeAPeriodAfterTheLastReport) {
  report(2.0);
  EXPECT_EQ(step(), Cause::kNone);
  EXPECT_EQ(step(kPeriod - kStep), Cause::kNone);
  EXPECT_EQ(figures.heartbeat(), 1);
  EXPECT_EQ(step(1), Cause::kSilent);
  EXPECT_EQ(value(), -kInfinite);
  EXPECT_EQ(step(100 * kPeriod), Cause::kSilent);
  EXPECT_EQ(figures.heartbeat(), 1);
  report(3.0);
  EXPECT_EQ(step(), Cause::kNone);
  EXPECT_EQ(value(), 3.0);  // nothing of the time before
  EXPECT_EQ(figures.heartbeat(), 2);
}

TEST_F(PlcFigures, BeatOncePerPeriodAndOnlyWithANewReport) {
  for (int i = 0; i < 400; ++i) {
    report(1.0);
    EXPECT_EQ(step(), Cause::kNone);
  }
  EXPECT_EQ(figures.heartbeat(), 100);
  for (int i = 0; i < 100; ++i) step();
  EXPECT_EQ(figures.heartbeat(), 101);  // by the reports since the last beat
}

TEST_F(PlcFigures, GoFromTheLastBeatToOne) {
  for (int i = 0; i < 65535; ++i) {
    report(1.0);
    step(kPeriod);
  }
  EXPECT_EQ(figures.heartbeat(), 65535);
  report(1.0);
  step(kPeriod);
  EXPECT_EQ(figures.heartbeat(), 1);  // 0 means that there was none
}

TEST_F(PlcFigures, HaveNoWordForAReportThatMustNotBeBelieved) {
  report(2.0);
  step();
  for (const Cause cause : {Cause::kOld, Cause::kClocksDisagree, Cause::kNoNames}) {
    figures.fail(cause, now + kPeriod);
    EXPECT_EQ(step(), cause);
    EXPECT_EQ(value(), -kInfinite);
    report(2.0);
    EXPECT_EQ(step(), Cause::kNone);
  }
  // A report that was late does not hide the silence behind it.
  figures.fail(Cause::kOld, now + kPeriod);
  step();
  EXPECT_EQ(step(2 * kPeriod), Cause::kSilent);
}

TEST_F(PlcFigures, AreFailSafeWhileTwoDaemonsTakeTurns) {
  for (int i = 0; i < 100; ++i) {
    report(2.0);
    if (i % 3 == 0) figures.fail(Cause::kOtherDaemon, now + kPeriod);
    report(2.0);
    EXPECT_EQ(step(), Cause::kOtherDaemon);
  }
  EXPECT_EQ(figures.heartbeat(), 0);
  for (int i = 0; i < 4; ++i) {
    report(2.0);
    step();
  }
  EXPECT_EQ(figures.cause(), Cause::kNone);
}

TEST_F(PlcFigures, NeedEachKindOfMessageThatTheSceneHas) {
  const double none = kInfinite;
  figures.need_separation(true);
  report(2.0);
  EXPECT_EQ(step(), Cause::kNoSeparation);
  figures.add(MessageKind::kSeparation, {&none, 1}, now + kPeriod);
  report(2.0);
  EXPECT_EQ(step(), Cause::kNone);
  for (int i = 0; i < 4; ++i) {
    report(2.0);
    step();
  }
  EXPECT_EQ(figures.cause(), Cause::kNoSeparation);
}

TEST_F(PlcFigures, AreNotKnownWhereAReportHasNone) {
  report(2.0);
  report(std::nan(""));
  report(2.0);
  EXPECT_EQ(step(), Cause::kNone);
  EXPECT_EQ(value(), -kInfinite);
}

// Whoever reads once per period, at any phase, meets the least figure of each report.
TEST_F(PlcFigures, HoldEachValueForAWholePeriodAndNoneForMoreThanThree) {
  Random random(62);
  struct Report {
    std::int64_t at;
    double value;
  };
  std::deque<Report> sent;
  for (int i = 0; i < 20'000; ++i) {
    for (int more = random.integer(1, 3); more > 0; --more) {
      sent.push_back({now, random.uniform(0.0, 10.0)});
      report(sent.back().value);
    }
    ASSERT_EQ(step(random.integer(1, static_cast<int>(kStep))), Cause::kNone);
    double of_period = kInfinite, of_three = kInfinite;
    for (const Report& each : sent) {
      if (now - each.at <= kPeriod) of_period = std::min(of_period, each.value);
      of_three = std::min(of_three, each.value);
    }
    ASSERT_LE(value(), of_period);
    ASSERT_GE(value(), of_three);
    while (now - sent.front().at > 3 * kPeriod) sent.pop_front();
  }
}

}  // namespace
}  // namespace clearance::plc
