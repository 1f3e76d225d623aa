#include "monitor/zones/zone_hysteresis.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

constexpr double kMargins = 0.03;

// Two pairs with margins of 0.01 + 0.02 each. The zone is entered below 0.1 and left above 0.15.
class ZoneHysteresisTest : public testing::Test {
 protected:
  ZoneHysteresisTest() {
    for (const char* name : {"a", "b"}) scene_.objects.push_back(test::moving(name, {}));
    scene_.objects[0].margin = 0.01;
    scene_.objects[1].margin = 0.02;
    scene_.pairs = {{0, 1, false}, {0, 1, false}};
    zone_ = test::zone_over(scene_, 0.1, 0.15);
  }

  // One tick in which the two pairs have these clearances. The lower bounds are 0.03 larger.
  const ZoneReport& tick(double first, double second, PairStatus status = PairStatus::kConverged) {
    ZoneHysteresis update(zone_, report_);
    return tick({.status = status, .lower = first + 0.03, .swept_lower = first + 0.03},
                {.status = status, .lower = second + 0.03, .swept_lower = second + 0.03});
  }
  const ZoneReport& tick(const PairBounds& first, const PairBounds& second) {
    ZoneHysteresis update(zone_, report_);
    update.add(0, first, kMargins);
    update.add(1, second, kMargins);
    update.finish(++cycle_, report_);
    return report_;
  }

  Scene scene_;
  Zone zone_;
  ZoneReport report_;
  std::uint64_t cycle_ = 0;
};

TEST_F(ZoneHysteresisTest, EntersBelowAndLeavesAboveWithHysteresisBetween) {
  EXPECT_FALSE(tick(0.2, 0.12).active);
  EXPECT_TRUE(tick(0.2, 0.09).active);
  EXPECT_TRUE(report_.changed);
  EXPECT_EQ(report_.since_cycle, 2u);
  EXPECT_EQ(report_.pair, 1u);
  EXPECT_TRUE(tick(0.2, 0.12).active);
  EXPECT_FALSE(report_.changed);
  EXPECT_EQ(report_.since_cycle, 2u) << "it entered then, and has not left";
  EXPECT_TRUE(tick(0.14, 0.16).active) << "every pair has to leave";
  EXPECT_FALSE(tick(0.16, 0.16).active);
  EXPECT_EQ(report_.since_cycle, 5u);
  EXPECT_FALSE(tick(0.14, 0.16).active);
}

TEST_F(ZoneHysteresisTest, ClearanceIsTheLowerBoundLessBothMargins) {
  EXPECT_NEAR(tick(0.3, 0.4).clearance, 0.3, 1e-12);
  EXPECT_LE(report_.clearance, 0.3);
}

TEST_F(ZoneHysteresisTest, IsProvedByEvaluationsAndByBoundsThatLieOutside) {
  EXPECT_TRUE(tick(0.05, 0.3).certified);
  EXPECT_TRUE(tick(0.2, 0.3, PairStatus::kCarried).certified);
  EXPECT_FALSE(tick(0.05, 0.3, PairStatus::kCarried).certified);
  EXPECT_FALSE(tick(0.05, 0.3, PairStatus::kStale).certified);
}

TEST_F(ZoneHysteresisTest, CarriedBoundsWithinTheHysteresisProveOnlyThatTheZoneIsNotEntered) {
  EXPECT_TRUE(tick(0.12, 0.3, PairStatus::kCarried).certified);
  EXPECT_FALSE(report_.active);
  tick(0.05, 0.3);
  EXPECT_FALSE(tick(0.12, 0.3, PairStatus::kCarried).certified);
  EXPECT_TRUE(report_.active);
}

TEST_F(ZoneHysteresisTest, IsEnteredByWhatWasTooNearSinceTheLastTickAndNamesIt) {
  const auto status = PairStatus::kConverged;
  const PairBounds nearest{.status = status, .lower = 0.23, .swept_lower = 0.23};
  PairBounds passing{.status = status, .lower = 0.53, .swept_lower = 0.08, .swept_upper = 0.09};
  EXPECT_TRUE(tick(nearest, passing).active);
  EXPECT_EQ(report_.pair, 1u);
  EXPECT_NEAR(report_.clearance, 0.2, 1e-12) << "of the other pair, and of now";
  EXPECT_NEAR(report_.swept_clearance, 0.05, 1e-12);
  EXPECT_TRUE(report_.certified) << "it was there";
  EXPECT_FALSE(tick(nearest, nearest).active);
  EXPECT_EQ(report_.pair, 0u);
  passing.swept_upper = 0.5;
  EXPECT_TRUE(tick(nearest, passing).active);
  EXPECT_FALSE(report_.certified) << "it may have been there";
}

TEST_F(ZoneHysteresisTest, AnUnknownPairIsNotOutside) {
  tick(-kInfinity, 0.3, PairStatus::kUnknown);
  EXPECT_TRUE(report_.active);
  EXPECT_FALSE(report_.certified);
  EXPECT_EQ(report_.pair, 0u);
  EXPECT_EQ(report_.clearance, -kInfinity);
}

TEST_F(ZoneHysteresisTest, PairsThatAreAddedTogetherProveOnlyThatTheyAreOutside) {
  for (const double clearance : {0.2, 0.12, 0.05}) {
    ZoneReport report = report_;
    ZoneHysteresis update(zone_, report_);
    update.add(0, {.status = PairStatus::kConverged, .lower = 0.33, .swept_lower = 0.33}, kMargins);
    update.add_rest({clearance, clearance}, 1);
    update.finish(1, report);
    EXPECT_EQ(report.active, clearance < 0.1) << clearance;
    EXPECT_EQ(report.certified, clearance >= 0.1) << clearance;
    EXPECT_EQ(report.clearance, clearance);
    EXPECT_EQ(report.pair, 1u);
  }
}

TEST_F(ZoneHysteresisTest, AZoneOfNoPairsIsNeverActive) {
  const ZoneHysteresis update(zone_, report_);
  update.finish(1, report_);
  EXPECT_FALSE(report_.active);
  EXPECT_TRUE(report_.certified);
}

}  // namespace
}  // namespace clearance
