// Reports of two partners become one stream.
#include "monitor/client/partner_merge.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "monitor/wire/report_check.hpp"
#include "monitor/wire/report_checksum.hpp"

namespace clearance::client {
namespace {

constexpr std::int64_t kPeriod = 1'000'000, kStart = 1'700'000'000'000'000'000;

clearance_msg_Distances report(const char* partner, std::uint64_t cycle, std::uint64_t lineage = 1,
                               double lower = 0.5) {
  clearance_msg_Distances message{};
  std::strcpy(message.partner, partner);
  message.daemon = static_cast<std::uint64_t>(partner[0]);
  message.cycle = cycle;
  message.lineage = lineage;
  message.now_ns = kStart + static_cast<std::int64_t>(cycle) * kPeriod;
  message.lower_all = lower;
  message.checksum = checksum_of(message);
  return message;
}

class Merge : public testing::Test {
 protected:
  bool take(const clearance_msg_Distances& message) {
    const bool is_next = merge.take(message);
    if (is_next) cycles.push_back(message.cycle);
    return is_next;
  }
  [[nodiscard]] PartnerState state() const { return merge.check().state; }

  PartnerMerge merge;
  std::vector<std::uint64_t> cycles;
};

TEST_F(Merge, HandsOutEachCycleOnceAndTellsThatBothAgree) {
  for (std::uint64_t cycle = 1; cycle <= 5; ++cycle) {
    const bool left_first = cycle % 2 == 0;
    EXPECT_TRUE(take(report(left_first ? "left" : "right", cycle)));
    EXPECT_FALSE(take(report(left_first ? "right" : "left", cycle)));
    if (cycle > 1) {
      EXPECT_EQ(state(), PartnerState::kAgrees);
      EXPECT_EQ(merge.check().cycle, cycle - 1);
    }
  }
  EXPECT_EQ(cycles, (std::vector<std::uint64_t>{1, 2, 3, 4, 5}));
}

TEST_F(Merge, TellsWithTheNextReportThatAPartnerIsMissing) {
  take(report("left", 1));
  EXPECT_EQ(state(), PartnerState::kAlone);
  take(report("right", 1));
  EXPECT_TRUE(take(report("left", 2)));
  EXPECT_EQ(state(), PartnerState::kAgrees);
  EXPECT_TRUE(take(report("left", 3)));
  EXPECT_EQ(state(), PartnerState::kMissing);
  EXPECT_EQ(merge.check().partner, "right");
  EXPECT_EQ(merge.check().cycle, 2u);
  EXPECT_FALSE(take(report("right", 2))) << "late";
}

TEST_F(Merge, TellsOtherBitsOfTheSameInputsFromOtherInputs) {
  take(report("left", 1));
  take(report("right", 1, 1, 0.5000001));
  take(report("left", 2));
  EXPECT_EQ(state(), PartnerState::kDifferent);
  take(report("right", 2, 9, 0.6));
  take(report("left", 3));
  EXPECT_EQ(state(), PartnerState::kOtherInputs);
  auto message = report("right", 3);
  message.state_checksum ^= 1;
  take(message);
  take(report("left", 4));
  EXPECT_EQ(state(), PartnerState::kDifferent) << "of what the message does not hold";
}

TEST_F(Merge, AReportWithAFlippedBitIsNotHandedOut) {
  take(report("left", 1));
  take(report("right", 1));
  auto broken = report("left", 2);
  broken.lower_all = -broken.lower_all;
  EXPECT_FALSE(take(broken));
  EXPECT_TRUE(take(report("right", 2)));
  EXPECT_EQ(state(), PartnerState::kCorrupt);
  EXPECT_EQ(merge.check().partner, "left");
  EXPECT_EQ(cycles, (std::vector<std::uint64_t>{1, 2}));
}

TEST_F(Merge, APartnerThatCountsLowerGoesOnWhereTheOtherFellSilent) {
  for (std::uint64_t cycle = 1; cycle <= 10; ++cycle) {
    take(report("left", cycle));
    auto apart = report("right", cycle, 7);
    apart.cycle -= cycle > 3 ? 3 : 0;
    apart.checksum = checksum_of(apart);
    EXPECT_FALSE(take(apart)) << cycle;
  }
  for (const std::uint64_t later : {1, 2}) {
    auto apart = report("right", 10 + later, 7);
    apart.cycle -= 3;
    apart.checksum = checksum_of(apart);
    EXPECT_EQ(take(apart), later == 2) << "the other one may only be late";
  }
}

TEST(ReportCheck, TheOtherPartnerIsNoOtherDaemonButOneThatBeginsAgainIs) {
  ReportChecker checker(100'000'000);
  const auto check = [&](const char* partner, std::uint64_t cycle) {
    return checker.check(report(partner, cycle), kStart);
  };
  EXPECT_FALSE(check("left", 5).other_daemon);
  EXPECT_FALSE(check("right", 6).other_daemon);
  EXPECT_EQ(check("left", 9).missed, 2u);
  EXPECT_TRUE(check("right", 1).other_daemon);
}

}  // namespace
}  // namespace clearance::client
