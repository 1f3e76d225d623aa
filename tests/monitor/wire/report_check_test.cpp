#include "monitor/wire/report_check.hpp"

#include <gtest/gtest.h>

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
  EXPECT_EQ(late.age_ns, 5'000'000'000);
  EXPECT_TRUE(checker.check(report_of(1, 3), kWhen - kLimit - 1).clocks_disagree);
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

}  // namespace
}  // namespace clearance
