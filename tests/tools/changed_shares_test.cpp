// Shares of a cell whose scene or whose reports change: what clients join of them meanwhile.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "config/cell/share_topics.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/interface/report.hpp"
#include "tests/tools/shared_cells.hpp"

namespace clearance {
namespace {

using client::ShareState;
using std::chrono::milliseconds;
using test::ChildProcess;
using test::kDaemon;
using test::kMerge;
using test::kUnknown;
using test::ScratchFolder;
using test::SharedCells;

class ChangedSharedCells : public SharedCells {
 protected:
  ChangedSharedCells() : SharedCells("commands: {from: [planner]}\n") {}
};

// Until all have changed, the last reports of the former scene count, as long as they are not late.
TEST_F(ChangedSharedCells, AreWholeWhileOneChangesAfterAnother) {
  start_all();
  client::SharedCell whole(connection, {.late_after = std::chrono::seconds(20)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole() && whole->minimum_certified; }))
      << logs();
  const std::vector<CellChange> change = {
      SetZoneThresholds{.zone = "near", .enter_below = 0.2, .leave_above = 0.25}};
  std::vector<std::unique_ptr<client::Connection>> connections;
  std::vector<std::unique_ptr<client::Commands>> commands;
  for (const Share& share : cell.shares.all) {
    connections.push_back(std::make_unique<client::Connection>(
        connection.participant().handle(), connection.participant().partition(),
        topics_of_share(cell.topics, share.name)));
    commands.push_back(std::make_unique<client::Commands>(*connections.back(), "planner"));
    const auto tried = commands.back()->send(change, {.dry_run = true});
    ASSERT_TRUE(tried && tried->done()) << logs();
  }
  const auto expect_whole = [&] {
    EXPECT_TRUE(whole.is_whole()) << whole.what_is_missing();
    EXPECT_EQ(whole->pairs_total, 3u);
    for (std::uint32_t pair = 0; pair < 3; ++pair) EXPECT_NE(status(whole, pair), kUnknown);
    EXPECT_NE(whole.zones().at(0).cause, static_cast<std::uint8_t>(ZoneCause::kNoShare));
    return HasFailure();
  };
  std::uint64_t revision = 0;
  for (const auto& each : commands) {
    EXPECT_EQ(whole->scene_revision, cell.scene.revision) << "not all have changed";
    const auto changed = each->send(change);
    ASSERT_TRUE(changed && changed->done()) << logs();
    revision = changed->scene_revision;
    for (int report = 0; report < 30 && !HasFailure(); ++report) {
      ASSERT_TRUE(whole.next(std::chrono::seconds(1)));
      expect_whole();
    }
  }
  EXPECT_TRUE(read_until(whole, [&] {
    return expect_whole() || whole->scene_revision == revision;
  })) << whole.what_is_missing();
  EXPECT_EQ(whole->scene_revision, revision);
}

// One that changes alone counts with its last report for that time only.
TEST_F(ChangedSharedCells, AreNotWholeOnceALastReportIsLate) {
  start_all();
  client::SharedCell whole(connection, {.late_after = milliseconds(500)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  client::Connection boxes(connection.participant().handle(), connection.participant().partition(),
                           topics_of_share(cell.topics, "boxes"));
  client::Commands commands(boxes, "planner");
  const auto changed =
      commands.send({SetZoneThresholds{.zone = "near", .enter_below = 0.2, .leave_above = 0.25}});
  ASSERT_TRUE(changed && changed->done()) << logs();
  EXPECT_TRUE(read_until(whole, [&] {
    EXPECT_TRUE(!whole.is_whole() || dds_time() - whole->publish_ns < 1'000'000'000);
    return !whole.is_whole();
  }));
  EXPECT_EQ(whole->scene_revision, cell.scene.revision) << "two of three have it";
  EXPECT_EQ(whole.shares()[0].state, ShareState::kOtherRevision);
  EXPECT_TRUE(whole.zones().at(0).active);
  EXPECT_EQ(whole->lower_all, -kInfinity);
}

// A command reaches every share, in one order. One that a share refuses changes none.
TEST_F(ChangedSharedCells, FollowACommandTogetherOrNotAtAll) {
  start_all();
  ChildProcess merge(kMerge,
                     test::with({file.path(), "--late-ms", "1000"}, test::dds_arguments(dds)));
  client::SharedCell whole(connection, {.late_after = milliseconds(1000)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  ASSERT_TRUE(merge.tells("share-heard", {"right floor"}));
  client::Commands commands(connection, "planner");
  const auto moved =
      commands.send({SetZoneThresholds{.zone = "near", .enter_below = 0.2, .leave_above = 0.25}});
  ASSERT_TRUE(moved) << merge.output() << logs();
  EXPECT_TRUE(moved->done()) << moved->reason;
  EXPECT_NE(moved->scene_revision, cell.scene.revision);
  EXPECT_NE(moved->in_force_from, 0u);
  EXPECT_TRUE(read_until(whole, [&] {
    return whole.is_whole() && whole->scene_revision == moved->scene_revision;
  })) << whole.what_is_missing();
  // An object that no share watches: the shares would leave its pairs out.
  const auto refused = commands.send(
      {AddObject{.yaml = "{name: cone, groups: [still], fixed: true, sphere: {radius: 0.1}}"}});
  ASSERT_TRUE(refused) << merge.output();
  EXPECT_FALSE(refused->done());
  EXPECT_NE(refused->reason.find("no share has changed"), std::string::npos) << refused->reason;
  read_until(
      whole, [] { return false; }, 1);
  EXPECT_TRUE(whole.is_whole()) << whole.what_is_missing();
  EXPECT_EQ(whole->scene_revision, moved->scene_revision);
}

// A share that was killed comes back with the scene that all have, and follows the next command.
TEST_F(ChangedSharedCells, AgreeAgainAfterARestartIfEachKeepsItsScene) {
  const ScratchFolder folder;
  const auto keep = [&](const std::string& share) {
    return std::vector<std::string>{"--keep-scene", (folder / (share + ".yaml")).string()};
  };
  for (const Share& share : cell.shares.all) start(share.name, keep(share.name));
  ChildProcess merge(kMerge,
                     test::with({file.path(), "--late-ms", "1000"}, test::dds_arguments(dds)));
  client::SharedCell whole(connection, {.late_after = milliseconds(1000)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  client::Commands commands(connection, "planner");
  const auto moved =
      commands.send({SetZoneThresholds{.zone = "near", .enter_below = 0.2, .leave_above = 0.25}});
  ASSERT_TRUE(moved && moved->done()) << merge.output() << logs();
  daemons["boxes"]->signal(SIGKILL);
  daemons["boxes"]->wait();
  const auto refused =
      commands.send({SetZoneThresholds{.zone = "near", .enter_below = 0.1, .leave_above = 0.2}}, {},
                    std::chrono::seconds(20));
  ASSERT_TRUE(refused) << merge.output();
  EXPECT_NE(refused->reason.find("'boxes'"), std::string::npos) << refused->reason;
  start("boxes", keep("boxes"));
  ASSERT_TRUE(read_until(
      whole, [&] { return whole.is_whole() && whole->scene_revision == moved->scene_revision; }))
      << whole.what_is_missing() << logs();
  const auto again =
      commands.send({SetZoneThresholds{.zone = "near", .enter_below = 0.1, .leave_above = 0.2}});
  ASSERT_TRUE(again) << merge.output() << logs();
  EXPECT_TRUE(again->done()) << again->reason;
  // Another share has kept the scene of the whole cell, too.
  daemons["boxes"]->signal(SIGKILL);
  daemons["boxes"]->wait();
  std::filesystem::copy_file(folder / "left floor.yaml", folder / "boxes.yaml",
                             std::filesystem::copy_options::overwrite_existing);
  start("boxes", keep("boxes"));
  EXPECT_TRUE(read_until(
      whole, [&] { return whole.is_whole() && whole->scene_revision == again->scene_revision; }))
      << whole.what_is_missing() << logs();
}

class SparseSharedCells : public SharedCells {
 protected:
  SparseSharedCells() : SharedCells("dds: {publish: changes, full_every_s: 0.5}\n") {}
};

TEST_F(SparseSharedCells, AreWholeWhereReportsCarryOnlyWhatChanged) {
  start_all();
  client::SharedCell whole(connection, {.late_after = milliseconds(500)});
  const auto knows_all = [&] {
    bool is_known = whole.is_whole();
    for (std::uint32_t pair = 0; pair < 3; ++pair) {
      is_known = is_known && status(whole, pair) != kUnknown;
    }
    return is_known;
  };
  // A reader begins between two full reports: until the second one it does not know all pairs.
  ASSERT_TRUE(read_until(whole, knows_all)) << logs() << whole.what_is_missing();
  // The same holds where a report did not come, as on a busy machine.
  std::uint64_t cycle = whole->cycle, missed = whole.missed();
  bool is_full = false;
  int checked = 0;
  EXPECT_TRUE(read_until(whole, [&] {
    is_full = (is_full || knows_all()) && whole.missed() == missed && whole.is_whole();
    EXPECT_TRUE(!is_full || knows_all())
        << whole.what_is_missing() << "\nstatus of the pairs: " << int{status(whole, 0)} << " "
        << int{status(whole, 1)} << " " << int{status(whole, 2)} << "; poses are "
        << whole->now_ns - whole->oldest_pose_ns << " ns old";
    checked += is_full ? 1 : 0;
    if (!is_full) cycle = whole->cycle;
    missed = whole.missed();
    return whole->cycle > cycle + 200 || HasFailure();
  })) << logs();
  EXPECT_GT(checked, 50);
}

}  // namespace
}  // namespace clearance
