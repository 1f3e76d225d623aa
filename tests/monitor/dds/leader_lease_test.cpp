// What one of two partners may write while it leads. Times are in periods of 1 ms.
#include "monitor/dds/leader_lease.hpp"

#include <gtest/gtest.h>

namespace clearance {
namespace {

class LeaderLeases : public testing::Test {
 protected:
  static constexpr std::int64_t kPeriod = 1'000'000, kLease = 20 * kPeriod;
  static constexpr std::int64_t kStart = 1'000 * kPeriod;

  LeaderLease lease{kPeriod};

  // The last notice is of the tick at that time.
  void notice(std::int64_t from, std::int64_t until) {
    for (std::int64_t at = from; at <= until; at += kPeriod) lease.noticed(at - kPeriod / 4, at);
  }
};

TEST_F(LeaderLeases, ALeaderWritesWhenItHasLedForALease) {
  notice(kStart, kStart + 30 * kPeriod);
  EXPECT_FALSE(lease.holds(kStart + 30 * kPeriod, kStart + 10 * kPeriod));
  EXPECT_TRUE(lease.holds(kStart + 30 * kPeriod + 1, kStart + 10 * kPeriod));
}

TEST_F(LeaderLeases, ALeaderWithoutNoticesStopsBeforeItsLeaseEnds) {
  const std::int64_t last = kStart + 30 * kPeriod;
  notice(kStart, last);
  EXPECT_TRUE(lease.holds(last + kLease * 3 / 4 - kPeriod, kStart));
  EXPECT_FALSE(lease.holds(last + kLease * 3 / 4, kStart));
}

// The other one may have taken over in that time.
TEST_F(LeaderLeases, ALeaderThatWasStoppedWaitsForAnotherLease) {
  const std::int64_t last = kStart + 30 * kPeriod, again = last + kLease;
  notice(kStart, last);
  notice(again, again + kLease - kPeriod);
  EXPECT_FALSE(lease.holds(again + kLease - kPeriod, kStart));
  notice(again + kLease, again + kLease);
  EXPECT_TRUE(lease.holds(again + kLease, kStart));
}

TEST_F(LeaderLeases, ALeaderThatMissesAFewTicksGoesOn) {
  const std::int64_t last = kStart + 30 * kPeriod, again = last + kLease / 2;
  notice(kStart, last);
  lease.noticed(again, again);
  EXPECT_TRUE(lease.holds(again, kStart));
}

TEST_F(LeaderLeases, ANoticeThatHasWaitedDoesNotProlongTheLease) {
  const std::int64_t last = kStart + 30 * kPeriod, now = last + kLease;
  notice(kStart, last);
  lease.noticed(now, last + kPeriod);
  EXPECT_FALSE(lease.holds(now, kStart));
}

TEST_F(LeaderLeases, BelowAHundredHertzALeaseLastsTwoPeriods) {
  EXPECT_EQ(LeaderLease(kPeriod).lease_ns(), kLease);
  EXPECT_EQ(LeaderLease(kLease).lease_ns(), 2 * kLease);
}

}  // namespace
}  // namespace clearance
