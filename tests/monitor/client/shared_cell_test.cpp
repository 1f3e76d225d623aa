// A client of a cell in shares over real DDS. The test plays the daemons.
#include "monitor/client/shared_cell.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "monitor/interface/report.hpp"
#include "tests/monitor/client/share_daemon.hpp"
#include "tests/shared/loopback.hpp"

namespace clearance::client {
namespace {

using std::chrono::milliseconds;
using test::eventually;

class ASharedCell : public testing::Test {
 protected:
  void open(std::vector<std::string> names) {
    whole.emplace(connection, SharedCellOptions{.late_after = std::chrono::seconds(5),
                                                .names = std::move(names)});
  }
  // Both shares report until a report of the whole cell has come.
  void begin(ShareDaemon& left, std::vector<std::string> names) {
    left.zones(1, false);
    right.zones(1, false);
    open(std::move(names));
    ASSERT_TRUE(report_until(left, [] { return true; }));
    EXPECT_TRUE(whole->is_whole()) << whole->what_is_missing();
  }
  [[nodiscard]] bool is_active(std::uint32_t zone) const { return whole->zones().at(zone).active; }
  // Both shares report until a report of the whole cell is so.
  template <class IsSo>
  bool report_until(ShareDaemon& left, const IsSo& is_so) {
    return eventually(
        [&] {
          left.report(cycle);
          right.report(cycle++);
          return whole->next(milliseconds(50)) && is_so();
        },
        std::chrono::seconds(20));
  }
  // The right share says that its zones are clear, but does not count.
  void expect_right_is_unknown() {
    ASSERT_EQ(whole->shares().size(), 2u);
    EXPECT_EQ(whole->shares()[0].state, ShareState::kWhole);
    EXPECT_EQ(whole->shares()[1].state, ShareState::kLate);
    EXPECT_EQ(whole->what_is_missing(), "the share 'right' is late");
    EXPECT_EQ((*whole)->unknown, cell.shares.all[1].pairs.size());
    EXPECT_EQ((*whole)->lower_all, -kInfinity);
    EXPECT_EQ((*whole)->swept_lower_all, -kInfinity);
    EXPECT_FALSE((*whole)->minimum_certified);
    EXPECT_EQ((*whole)->active_zones._length, 2u);
    for (const std::uint32_t zone : {kWide, kFar}) {
      EXPECT_TRUE(is_active(zone));
      EXPECT_EQ(whole->zones().at(zone).cause, static_cast<std::uint8_t>(ZoneCause::kNoShare));
    }
    EXPECT_EQ(whole->separation()->zones._buffer[0].validity, 0);
    EXPECT_EQ(whole->separation()->zones._buffer[0].scaling, 0.0);
    EXPECT_LT(std::abs(dds_time() - (*whole)->publish_ns), 5'000'000'000)
        << "it is as old as the share that counts";
  }

  Cell cell = cell_in_shares();
  DdsOptions dds = test::own_dds();
  Connection connection{dds, cell.topics};
  ShareDaemon right{dds, cell, "right", 3};
  std::optional<SharedCell> whole;
  std::uint64_t cycle = 1;
};

// The reports of the one partner, which ticks apart, always come first.
TEST_F(ASharedCell, HasTheZonesOfAPartnerWhoseReportsComeSecond) {
  open({"left", "right"});
  ShareDaemon apart(dds, cell, "left", 1, "one"), leader(dds, cell, "left", 2, "two");
  ASSERT_TRUE(
      eventually([&] { return apart.is_heard() && leader.is_heard() && right.is_heard(); }));
  for (ShareDaemon* const daemon : {&apart, &leader, &right}) daemon->zones(1, false);
  const auto next = [&] {
    apart.report(cycle);
    right.report(cycle);
    const bool came = whole->next(milliseconds(500));
    leader.report(cycle++);
    return came;
  };
  ASSERT_TRUE(eventually([&] { return next() && whole->is_whole() && !is_active(kWide); }));
  leader.zones(cycle, true);
  EXPECT_TRUE(eventually([&] { return next() && is_active(kWide); }, std::chrono::seconds(10)));
  EXPECT_EQ(whole->zones().at(kWide).cause, static_cast<std::uint8_t>(ZoneCause::kNear));
}

// The first report has the states of all zones, although the names came in another order.
TEST_F(ASharedCell, BeginsWithAllZonesWhereNamesAreInAnotherOrder) {
  ShareDaemon left(dds, cell, "left", 1);
  begin(left, {"right", "left"});
  EXPECT_EQ(whole->zones().size(), 2u);
  EXPECT_NE(whole->catalogue(), nullptr);
}

TEST_F(ASharedCell, HasASeparationThatNoShareHasReportedAndItStopsTheRobot) {
  ShareDaemon left(dds, cell, "left", 1);
  begin(left, {"left", "right"});
  ASSERT_NE(whole->separation(), nullptr);
  ASSERT_EQ(whole->separation()->zones._length, 1u);
  const clearance_msg_ZoneSeparation& zone = whole->separation()->zones._buffer[0];
  EXPECT_EQ(zone.zone, kFar);
  EXPECT_EQ(zone.validity, 0);
  EXPECT_EQ(zone.scaling, 0.0);
}

// The state of a zone comes after the report of its tick, or is lost.
TEST_F(ASharedCell, HasTheZonesActiveThatTheReportOfAShareLists) {
  ShareDaemon left(dds, cell, "left", 1);
  begin(left, {"left", "right"});
  EXPECT_FALSE(is_active(kWide));
  EXPECT_EQ((*whole)->active_zones._length, 0u);
  ASSERT_TRUE(eventually([&] {
    left.report(cycle, dds_time(), {kWide});
    right.report(cycle++);
    return whole->next(milliseconds(50)) && is_active(kWide);
  }));
  EXPECT_EQ(whole->zones().at(kWide).cause, static_cast<std::uint8_t>(ZoneCause::kNear));
  ASSERT_EQ((*whole)->active_zones._length, 1u);
  EXPECT_EQ((*whole)->active_zones._buffer[0], kWide);
  EXPECT_FALSE(is_active(kFar));
}

// The clock of the share's machine is ahead, so that its last report seems young for longer.
TEST_F(ASharedCell, HasAShareLateThatIsSilentAlthoughItsStampsAreAhead) {
  ShareDaemon left(dds, cell, "left", 1);
  begin(left, {"left", "right"});
  whole.emplace(connection,
                SharedCellOptions{.late_after = milliseconds(400), .names = {"left", "right"}});
  const std::int64_t last = dds_time() + 350'000'000;
  ASSERT_TRUE(eventually([&] {
    left.report(cycle);
    right.report(cycle++, dds_time() + 350'000'000);
    return whole->next(milliseconds(50)) && whole->is_whole() && !whole->fail_safe();
  })) << name(whole->reason());
  EXPECT_TRUE(eventually([&] {
    left.report(cycle++);
    return whole->next(milliseconds(50)) && !whole->is_whole();
  }));
  EXPECT_TRUE(whole->fail_safe());
  EXPECT_LT(dds_time() - last, 3'000'000'000);
  const ShareCheck& check = whole->shares()[1];
  EXPECT_EQ(check.name, "right");
  EXPECT_EQ(check.state, ShareState::kLate);
  EXPECT_LT(check.age_ns, 400'000'000) << "by its stamp it is on time";
}

// The right share's clock is behind, so that its reports seem old.
TEST_F(ASharedCell, HasAShareLateAfterThreePeriodsUnlessTheCallerStatesATime) {
  Cell slow = cell;
  slow.scene.rate_hz = 0.5;
  ShareDaemon left(dds, slow, "left", 1);
  left.zones(1, false);
  right.zones(1, false);
  whole.emplace(connection, SharedCellOptions{.names = {"left", "right"}});
  right.set_clock_ahead(-4'000'000'000);
  EXPECT_TRUE(report_until(left, [&] { return whole->is_whole(); })) << whole->what_is_missing();
  right.set_clock_ahead(-8'000'000'000);
  EXPECT_TRUE(report_until(left, [&] { return !whole->is_whole(); }));
  EXPECT_EQ(whole->shares()[1].state, ShareState::kLate);
}

// A clock was set back: the report is as old as it was published, and not younger.
TEST_F(ASharedCell, IsNoYoungerThanItsOldestPart) {
  ShareDaemon left(dds, cell, "left", 1);
  begin(left, {"left", "right"});
  const std::int64_t before = dds_time() - 1'000'000'000;
  EXPECT_TRUE(eventually(
      [&] {
        left.report(cycle);
        right.report(cycle++, before);
        return whole->next(milliseconds(50)) && (*whole)->publish_ns == before;
      },
      std::chrono::seconds(10)));
}

// The clock is ahead, or was set back, by more than a report may be old: its reports come on time,
// and say that the zones are clear.
TEST_F(ASharedCell, HasAShareUnknownByNameWhoseTimesAreOfTheFutureOrOfThePast) {
  ShareDaemon left(dds, cell, "left", 1);
  begin(left, {"left", "right"});
  for (const std::int64_t ahead_ns : {8'000'000'000, -8'000'000'000}) {
    SCOPED_TRACE(ahead_ns);
    right.set_clock_ahead(ahead_ns);
    right.zones(cycle, false);
    ASSERT_TRUE(report_until(left, [&] { return !whole->is_whole(); }));
    for (int report = 0; report < 20 && !HasFailure(); ++report) {
      ASSERT_TRUE(report_until(left, [] { return true; }));
      expect_right_is_unknown();
      EXPECT_EQ(whole->shares()[1].age_ns<0, ahead_ns> 0);
    }
    right.set_clock_ahead(0);
    right.zones(cycle, false);
    EXPECT_TRUE(report_until(left, [&] {
      return whole->is_whole() && !is_active(kWide) && !is_active(kFar);
    })) << whole->what_is_missing();
  }
}

// The cell as the daemons of another build divide it: its pairs are in other shares.
Cell divided_otherwise(Cell cell) {
  cell.shares.all[0].pairs = {1};
  cell.shares.all[1].pairs = {0, 2};
  return cell;
}

// The right share is still that of this build, so no share has the pair a-b.
TEST_F(ASharedCell, HasAShareUnknownByNameThatDividesTheCellOtherwise) {
  const Cell otherwise = divided_otherwise(cell);
  std::optional<ShareDaemon> left(std::in_place, dds, cell, "left", 1);
  begin(*left, {"left", "right"});
  const auto is_refused = [&] {
    return whole->shares()[0].state == ShareState::kOtherDivision && is_active(kWide) &&
           !is_active(kFar) && (*whole)->lower_all == -kInfinity;
  };
  left.emplace(dds, otherwise, "left", 4);
  left->zones(cycle, false);
  ASSERT_TRUE(report_until(*left, is_refused)) << whole->what_is_missing();
  EXPECT_EQ(whole->what_is_missing(), "the share 'left' is divided otherwise");
  left.emplace(dds, cell, "left", 5);
  left->zones(cycle, false);
  ASSERT_TRUE(report_until(*left, [&] { return whole->shares()[0].state == ShareState::kHeld; }));
  EXPECT_EQ(whole->what_is_missing(), "the share 'left' is held") << "another daemon once more";
  EXPECT_EQ(whole->reason(), ReportError::kOtherSource);
  whole->acknowledge();
  EXPECT_TRUE(report_until(*left, [&] { return whole->is_whole() && !is_active(kWide); }))
      << whole->what_is_missing();
  left->set_pairs(2);
  EXPECT_TRUE(report_until(*left, is_refused)) << whole->what_is_missing();
}

// One after another, the daemons of all shares are those of another build.
TEST_F(ASharedCell, FollowsADivisionThatAllSharesHave) {
  const Cell otherwise = divided_otherwise(cell);
  std::optional<ShareDaemon> left(std::in_place, dds, cell, "left", 1);
  begin(*left, {"left", "right"});
  left.emplace(dds, otherwise, "left", 4);
  left->zones(cycle, false);
  ASSERT_TRUE(report_until(*left, [&] { return !whole->is_whole(); }));
  ShareDaemon later(dds, otherwise, "right", 5);
  later.zones(cycle, false);
  EXPECT_TRUE(eventually([&] {
    left->report(cycle);
    later.report(cycle++);
    return whole->next(milliseconds(50)) && whole->is_whole();
  })) << whole->what_is_missing();
}

// The share has two partners. The state that is told covers all their reports, not only the last
// ones.
TEST_F(ASharedCell, TellsOnceThatPartnersDifferedAlthoughTheyAgreeAgain) {
  ShareDaemon one(dds, cell, "left", 1, "one"), two(dds, cell, "left", 2, "two");
  Connection alone(dds, topics_of_share(cell.topics, "left"));
  Reports reports(alone);
  begin(one, {"left", "right"});
  two.zones(1, false);
  const auto report_all = [&](int times) {
    for (int i = 0; i < times; ++i, ++cycle) {
      one.report(cycle);
      two.report(cycle);
      right.report(cycle);
    }
    std::this_thread::sleep_for(milliseconds(300));
  };
  const auto told = [&] { return whole->shares()[0].partner.state; };
  ASSERT_TRUE(eventually([&] {
    report_all(3);
    const bool came = whole->newest(milliseconds(50)) && reports.newest(milliseconds(50));
    return came && told() == PartnerState::kAgrees &&
           reports.partner().state == PartnerState::kAgrees;
  }));
  two.set_bits(7);
  report_all(1);
  two.set_bits(0);
  report_all(4);
  ASSERT_TRUE(whole->newest(milliseconds(50)) && reports.newest(milliseconds(50)));
  EXPECT_EQ(told(), PartnerState::kDifferent);
  EXPECT_EQ(reports.partner().state, PartnerState::kDifferent);
  report_all(2);
  ASSERT_TRUE(whole->newest(milliseconds(50)) && reports.newest(milliseconds(50)));
  EXPECT_EQ(told(), PartnerState::kAgrees);
  EXPECT_EQ(reports.partner().state, PartnerState::kAgrees);
}

// The clock was set back, or ahead and back, by less. What it says then counts, although the state
// that it wrote before has a later time.
TEST_F(ASharedCell, HasTheZonesThatAShareWritesAfterItsClockWasSetBack) {
  ShareDaemon left(dds, cell, "left", 1);
  begin(left, {"left", "right"});
  for (const std::int64_t ahead_ns : {-2'000'000'000, 2'000'000'000, 0}) {
    SCOPED_TRACE(ahead_ns);
    right.set_clock_ahead(ahead_ns);
    ASSERT_TRUE(report_until(left, [&] { return whole->is_whole() && !is_active(kFar); }));
    for (const bool active : {true, false}) {
      right.zones(cycle, active);
      EXPECT_TRUE(report_until(left, [&] { return is_active(kFar) == active; }));
      EXPECT_EQ(is_active(kWide), active);
      EXPECT_TRUE(whole->is_whole()) << whole->what_is_missing();
    }
  }
}

// The catalogue of one share names the separations of all.
TEST(SharesCatalogue, NamesTheZonesWithSeparationOfAllShares) {
  Cell cell = cell_in_shares();
  select_share(cell, 0);
  ASSERT_FALSE(cell.scene.zones[kFar].separation) << "the share has no pair of it";
  const auto catalogue = make_catalogue(cell, {}, CataloguePairs::kOfWholeCell);
  ASSERT_EQ(catalogue->separated_zones._length, 1u);
  EXPECT_EQ(catalogue->separated_zones._buffer[0], kFar);
}

}  // namespace
}  // namespace clearance::client
