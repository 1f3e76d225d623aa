#include "monitor/wire/report_check.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace clearance {
namespace {

constexpr std::int64_t kWhen = 1'700'000'000'000'000'000, kLimit = 500'000'000;

clearance_msg_Distances report_of(std::uint64_t daemon, std::uint64_t cycle,
                                  std::int64_t publish_ns = kWhen) {
  clearance_msg_Distances report{};
  report.daemon = daemon;
  report.cycle = cycle;
  report.publish_ns = publish_ns;
  return report;
}

TEST(ReportCheck, FindsReportsThatAClientReadsLate) {
  ReportChecker checker(kLimit);
  EXPECT_TRUE(checker.check(report_of(1, 1), kWhen + kLimit).fresh());
  const ReportCheck late = checker.check(report_of(1, 2), kWhen + 5'000'000'000);
  EXPECT_TRUE(late.is_old);
  EXPECT_FALSE(late.fresh());
  EXPECT_EQ(late.age_ns, 5'000'000'000);
  const ReportCheck early = checker.check(report_of(1, 3), kWhen - kLimit - 1);
  EXPECT_TRUE(early.clocks_disagree);
  EXPECT_FALSE(early.fresh());
  EXPECT_TRUE(checker.check(report_of(1, 4, 0), kWhen).fresh()) << "not published: a recording";
}

TEST(ReportCheck, CountsWhatIsMissingWithinOneDaemonOnly) {
  ReportChecker checker(kLimit);
  EXPECT_EQ(checker.check(report_of(1, 100), kWhen).missed, 0u);
  EXPECT_EQ(checker.check(report_of(1, 104), kWhen).missed, 3u);
  const ReportCheck other = checker.check(report_of(2, 900), kWhen);
  EXPECT_TRUE(other.other_daemon);
  EXPECT_EQ(other.missed, 0u);
  EXPECT_FALSE(checker.check(report_of(2, 901), kWhen).other_daemon);
  EXPECT_TRUE(checker.check(report_of(2, 1), kWhen).other_daemon) << "the same id counts anew";
}

TEST(ReportCheck, TellsAChangedSceneFromAnotherDaemon) {
  ReportChecker checker(kLimit);
  const auto check = [&checker](std::uint64_t daemon, std::uint64_t cycle, std::uint64_t revision) {
    clearance_msg_Distances report = report_of(daemon, cycle);
    report.scene_revision = revision;
    return checker.check(report, kWhen);
  };
  EXPECT_FALSE(check(1, 10, 5).other_scene) << "the first report";
  const ReportCheck changed = check(1, 13, 6);
  EXPECT_TRUE(changed.other_scene);
  EXPECT_FALSE(changed.other_daemon);
  EXPECT_EQ(changed.missed, 2u);
  EXPECT_FALSE(check(1, 14, 6).other_scene);
  EXPECT_TRUE(check(2, 15, 6).other_daemon);
  EXPECT_TRUE(check(0, 20, 6).other_daemon);
  EXPECT_FALSE(check(0, 21, 7).other_daemon) << "a replay that goes on with another scene";
  EXPECT_TRUE(check(0, 40, 8).other_daemon) << "another replay";
}

clearance_msg_Distances of_partner(const char* partner, std::uint64_t daemon, std::uint64_t cycle) {
  clearance_msg_Distances report = report_of(daemon, cycle);
  std::strcpy(report.partner, partner);
  return report;
}

TEST(ReportCheck, TakesPartnersForOneDaemonWhileBothSayThatTheyAre) {
  struct Next {
    const char* before;
    const char* now;
    std::uint64_t daemon;
    bool is_other;
  };
  constexpr Next kNext[] = {
      {"left", "right", 2, false}, {"left", "left", 2, false}, {"left", "", 2, true},
      {"", "right", 2, true},      {"", "", 2, true},          {"", "", 1, false},
      {"left", "", 1, false},
  };
  for (const Next& next : kNext) {
    ReportChecker checker(kLimit);
    EXPECT_FALSE(checker.check(of_partner(next.before, 1, 5), kWhen).other_daemon);
    const ReportCheck found = checker.check(of_partner(next.now, next.daemon, 6), kWhen);
    EXPECT_EQ(found.other_daemon, next.is_other) << next.before << " -> " << next.now;
  }
}

TEST(ReportCheck, KnowsAReportThatItsDaemonHasSentBefore) {
  struct Message {
    const char* partner;
    std::uint64_t daemon, cycle;
    bool is_had;
  };
  constexpr Message kMessages[] = {
      {"", 1, 5, true},  {"", 1, 4, true},      {"", 1, 6, false},
      {"", 2, 5, false}, {"left", 1, 5, false},
  };
  ReportChecker checker(kLimit);
  checker.check(report_of(1, 5), kWhen);
  for (const Message& message : kMessages) {
    EXPECT_EQ(checker.has_had(of_partner(message.partner, message.daemon, message.cycle)),
              message.is_had)
        << message.partner << message.daemon << " " << message.cycle;
  }
  ReportChecker of_replay(kLimit);
  of_replay.check(report_of(0, 5), kWhen);
  EXPECT_FALSE(of_replay.has_had(report_of(0, 5))) << "replays have no number of a daemon";
}

// The times of two lineages are comparable, their cycles are not.
class ReportLineages : public testing::Test {
 protected:
  static constexpr std::int64_t kStep = 1'000'000;

  // The reports that are missing before this one.
  std::uint64_t missed(std::uint64_t lineage, std::uint64_t cycle, std::int64_t now_ns) {
    clearance_msg_Distances report = of_partner("left", 1, cycle);
    report.lineage = lineage;
    report.now_ns = now_ns;
    report.period_ns = period_ns;
    return checker.check(report, kWhen).missed;
  }
  ReportChecker checker{kLimit};
  std::int64_t period_ns = kStep;
};

TEST_F(ReportLineages, CountWhatIsMissingBetweenThemByTime) {
  struct Change {
    std::int64_t after_ns;
    std::uint64_t missed;
  };
  constexpr Change kChanges[] = {
      {-5 * kStep, 0},        {0, 0},         {kStep, 0},     {kStep + 2 * kStep / 5, 0},
      {kStep + kStep / 2, 1}, {2 * kStep, 1}, {9 * kStep, 8},
  };
  for (const Change& change : kChanges) {
    checker = ReportChecker(kLimit);
    EXPECT_EQ(missed(1, 5, 100 * kStep), 0u);
    EXPECT_EQ(missed(1, 6, 101 * kStep), 0u);
    EXPECT_EQ(missed(2, 700, 101 * kStep + change.after_ns), change.missed) << change.after_ns;
  }
}

TEST_F(ReportLineages, MissNoneWhereTheNextCycleIsToldLate) {
  struct Change {
    std::int64_t after_ns;
    std::uint64_t missed;
  };
  for (const Change& change :
       {Change{kStep, 0}, Change{2 * kStep - 1, 0}, Change{2 * kStep, 1}, Change{4 * kStep, 3}}) {
    checker = ReportChecker(kLimit);
    EXPECT_EQ(missed(1, 5, 100 * kStep), 0u);
    EXPECT_EQ(missed(2, 6, 100 * kStep + change.after_ns), change.missed) << change.after_ns;
  }
}

TEST_F(ReportLineages, CountInStatedPeriodsWhateverTheLastStepWas) {
  EXPECT_EQ(missed(1, 5, 100 * kStep + kStep * 3 / 4), 0u) << "late";
  EXPECT_EQ(missed(1, 6, 101 * kStep), 0u);
  EXPECT_EQ(missed(2, 700, 102 * kStep), 0u);
}

TEST_F(ReportLineages, CountByCyclesWhereNoPeriodIsStated) {
  period_ns = 0;
  EXPECT_EQ(missed(1, 5, 100 * kStep), 0u);
  EXPECT_EQ(missed(1, 7, 101 * kStep), 1u) << "two periods";
  EXPECT_EQ(missed(2, 10, 102 * kStep), 2u);
  EXPECT_EQ(missed(3, 11, 103 * kStep), 0u);
  EXPECT_EQ(missed(4, 15, 109 * kStep), 3u);
}

// No daemon states such periods.
TEST_F(ReportLineages, CountWithForgedPeriods) {
  for (const std::int64_t forged :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()}) {
    checker = ReportChecker(kLimit);
    period_ns = forged;
    EXPECT_EQ(missed(1, 5, 100 * kStep), 0u);
    EXPECT_EQ(missed(2, 6, 200 * kStep), 0u);
  }
}

}  // namespace
}  // namespace clearance
