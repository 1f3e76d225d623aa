// SIGHUP makes a running daemon read its cell again, over real DDS.
#include <fmt/format.h>

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <thread>

#include "monitor/client/client.hpp"
#include "monitor/recording/recorded_cell.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance::test {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  text.replace(text.find(what), what.size(), by);
  return text;
}

class DaemonReload : public testing::Test {
 protected:
  void start(std::vector<std::string> more = {}) {
    daemon.emplace(kDaemon, with(with({cell.path()}, dds_arguments(dds)), more));
    distances.settle();
    robot.send(0.0);
  }
  // The daemon reads this text instead of the first one.
  void reload(const std::string& changed) {
    std::ofstream(cell.path()) << changed;
    daemon->signal(SIGHUP);
  }
  // Sends a pose a report until the daemon has logged this code. Every cycle is reported.
  void run_until_told(const char* code, const std::vector<std::string>& names = {}) {
    const bool came = eventually([&] {
      const auto report = distances.next();
      if (report == nullptr) return false;
      if (cycle != 0) {
        EXPECT_EQ((*report)->cycle, cycle + 1);
      }
      cycle = (*report)->cycle;
      if (revision != (*report)->scene_revision) first_of_revision = cycle;
      revision = (*report)->scene_revision;
      unknown = (*report)->unknown;
      pairs = (*report)->pairs._length;
      robot.send(t_s += 0.005);
      return daemon->told(code, names);
    });
    ASSERT_TRUE(came) << code << '\n' << daemon->output();
  }

  std::string text = small_cell("reload");
  CellFile cell{text};
  Cell read = cell.cell();
  DdsOptions dds = own_dds();
  Participant client{dds};
  Distances distances{client, read};
  Poses robot{client, read};
  double t_s = 0.0;
  std::uint64_t cycle = 0, revision = 0, first_of_revision = 0;
  std::uint32_t unknown = 0, pairs = 0;
  std::optional<ChildProcess> daemon;
};

TEST_F(DaemonReload, AChangedCellIsInForceWithoutAMissingCycleAndKnowsWhatItKnew) {
  start();
  run_until_told("started");
  ASSERT_EQ(revision, read.scene.revision);
  ASSERT_EQ(pairs, 3u);
  const std::string changed =
      replaced(text, "  - {name: floor,",
               "  - {name: wall, fixed: true, groups: [still], pose: {xyz: [0, 5, 0]}, box: {size: "
               "[9, 1, 9]}}\n  - {name: floor,");
  client::Connection connection(dds);
  client::Catalogue catalogue(connection);
  reload(changed);
  run_until_told("scene-changed");
  for (int i = 0; i < 20; ++i) run_until_told("scene-changed");
  const Cell now = cell.cell();
  EXPECT_NE(now.scene.revision, read.scene.revision);
  EXPECT_EQ(revision, now.scene.revision);
  EXPECT_EQ(unknown, 0u) << "poses of the revision before are still used";
  EXPECT_EQ(pairs, 5u);
  EXPECT_TRUE(eventually([&] {
    catalogue.update();
    return catalogue.revision() == now.scene.revision;
  }));
  EXPECT_TRUE(catalogue.pair("wall", "left"));
}

TEST_F(DaemonReload, TheSmallestDistanceAtTheEndIsThatOfAllCells) {
  start();
  run_until_told("started");
  const std::string rule = "  - {between: [left, right], publish: true}\n";
  std::string changed = replaced(text, rule, "");
  const std::size_t zones = changed.find("zones:");
  changed.erase(zones, changed.find("simulation:") - zones);
  reload(changed);
  ASSERT_TRUE(eventually([&] {
    run_until_told("scene-changed");  // reports that were made before may still come
    return revision != read.scene.revision;
  }));
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0);
  EXPECT_TRUE(daemon->wrote(", left - right, at cycle ")) << daemon->output();
}

TEST_F(DaemonReload, WithReloadAChangedFileIsReadWithoutASignal) {
  start({"--reload"});
  run_until_told("started");
  std::ofstream(cell.path()) << replaced(text, "box: {size: [0.2, 0.3, 0.2]}",
                                         "margin: 0.01, box: {size: [0.2, 0.3, 0.2]}");
  const std::uint64_t changed = cell.cell().scene.revision;
  EXPECT_TRUE(eventually([&] {
    run_until_told("scene-changed");  // reports that were made before may still come
    return revision == changed;
  }));
  std::ofstream(cell.path()) << replaced(text, "rate_hz: 200", "rate_hz: fast");
  run_until_told("scene-refused");
}

TEST_F(DaemonReload, ACellWithAMistakeOrWithAnotherRateIsRefusedAndTheTicksGoOn) {
  start();
  run_until_told("started");
  reload(replaced(text, "box: {size: [0.2, 0.2, 0.2]}", "box: {sizes: [0.2]}"));
  run_until_told("scene-refused");
  EXPECT_TRUE(eventually([&] { return daemon->output().find("sizes") != std::string::npos; }));
  reload(text);
  run_until_told("scene-unchanged");
  reload(replaced(text, "rate_hz: 200", "rate_hz: 100"));
  run_until_told("scene-refused", {"rate", "restart"});
  for (int i = 0; i < 5; ++i) run_until_told("started");
  EXPECT_EQ(revision, read.scene.revision);
}

TEST_F(DaemonReload, ManyChangesInARowLoseNothing) {
  start();
  run_until_told("started");
  for (int i = 0; i < 10; ++i) {
    const std::string margin = std::to_string(1 + i);
    reload(replaced(text, "box: {size: [0.2, 0.3, 0.2]}",
                    "margin: 0.0" + margin + ", box: {size: [0.2, 0.3, 0.2]}"));
    const std::uint64_t expected = cell.cell().scene.revision;
    for (int tick = 0; revision != expected; ++tick) {
      ASSERT_LT(tick, 2000);
      run_until_told("started");
    }
  }
  EXPECT_EQ(unknown, 0u);
}

TEST_F(DaemonReload, ARecordingOfManyChangesReplaysBitForBitWithoutTheFilesOfTheCell) {
  const ScratchFolder folder;
  const std::string file = (folder / "run.mcap").string();
  start({"--record", file});
  run_until_told("started");
  const std::string wall =
      "  - {name: wall, fixed: true, groups: [still], pose: {xyz: [0, 5, 0]}, box: {size: [9, 1, "
      "9]}}\n  - {name: floor,";
  // The right box hangs on the left one: it has no motion of its own, and no distance from it.
  std::string attached = replaced(text, "groups: [arm], box: {size: [0.2, 0.3, 0.2]}",
                                  "attached: {to: left, pose: {xyz: [1, 0, 0]}}, groups: [arm], "
                                  "box: {size: [0.2, 0.3, 0.2]}");
  attached = replaced(attached, "  - {between: [left, right], publish: true}\n", "");
  attached = replaced(attached, "between: [arm, arm]", "between: [arm, still]");
  attached = attached.substr(0, attached.find("    - {object: right"));
  const std::vector<std::string> texts = {replaced(text, "  - {name: floor,", wall), attached,
                                          text};
  for (const std::string& each : texts) {
    reload(each);
    const std::uint64_t expected = cell.cell().scene.revision;
    for (int tick = 0; revision != expected; ++tick) {
      ASSERT_LT(tick, 2000) << daemon->output();
      run_until_told("started");
    }
    for (int i = 0; i < 20; ++i) run_until_told("started");
  }
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  std::ofstream(cell.path()) << "gone";
  const std::string table = (folder / "t.csv").string();
  ChildProcess replay(kReplay, {"check", file, "--compare", "--csv", table});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
  const std::string rows = read_text(table);
  EXPECT_NE(rows.find(",wall,"), std::string::npos);
  EXPECT_NE(rows.find(fmt::format(",{:016x},", revision)), std::string::npos);
}

// A recorder that listens reads the changed cell's file, and the catalogue says when it came.
TEST_F(DaemonReload, ARecorderThatListensKeepsTheChangedCellWithItsFiles) {
  const ScratchFolder folder;
  const std::string file = (folder / "run.mcap").string();
  ChildProcess recorder(kRecord, with({"-o", file, "--cell", cell.path()}, dds_arguments(dds)));
  start();
  run_until_told("started");
  const std::string rock = (folder / "rock.obj").string();
  write_text(rock, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  reload(replaced(text, "  - {name: floor,",
                  "  - {name: wall, fixed: true, groups: [still], pose: {xyz: [0, 5, 0]}, mesh: "
                  "{file: " +
                      rock + "}}\n  - {name: floor,"));
  run_until_told("scene-changed");
  for (int i = 0; i < 200; ++i) run_until_told("scene-changed");
  recorder.signal(SIGTERM);
  EXPECT_EQ(recorder.wait(), 0) << recorder.output();
  std::ofstream(cell.path()) << "gone";
  std::filesystem::remove(rock);
  const auto described = described_scenes({file});
  ASSERT_GE(described.size(), 2u);
  EXPECT_EQ(described.back().revision, revision);
  EXPECT_EQ(described.back().since.from, first_of_revision);
  EXPECT_EQ(described.back().cell_file, cell.path());
  const std::string table = (folder / "t.csv").string();
  ChildProcess replay(kReplay, {"check", file, "--compare-bounds", "--csv", table});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
  EXPECT_NE(read_text(table).find(",wall,"), std::string::npos);
}

// A client that comes after a change gets the catalogue of the cell in force, and since when.
TEST_F(DaemonReload, ALateClientGetsThePresentCellAndSinceWhen) {
  start();
  run_until_told("started");
  reload(replaced(text, "enter_below: 0.3", "enter_below: 0.31"));
  run_until_told("scene-changed");
  for (int i = 0; i < 20; ++i) run_until_told("scene-changed");
  client::Connection connection(dds);
  client::Catalogue catalogue(connection);
  client::Zones zones(connection);
  ASSERT_TRUE(eventually([&] {
    catalogue.update();
    zones.update();
    return catalogue.message() != nullptr && zones.states().size() == 1;
  }));
  EXPECT_EQ(catalogue.revision(), cell.cell().scene.revision);
  EXPECT_EQ(catalogue.message()->in_force_from, first_of_revision);
  EXPECT_LT(catalogue.message()->began_after, first_of_revision);
  EXPECT_GT(catalogue.message()->began_after, 0u);
}

// A client's loop knows names only, and its pair has another id in the changed cell.
TEST_F(DaemonReload, AClientThatKnowsNamesFollowsWithoutARestart) {
  start();
  run_until_told("started");
  client::Connection connection(dds);
  client::Reports reports(connection);
  client::Catalogue names(connection);
  client::Pair pair(names, "right", "floor");
  std::set<std::uint32_t> ids;
  std::set<std::uint64_t> revisions;
  std::uint64_t without = 0, wrong = 0;
  const auto follow = [&] {
    run_until_told("started");
    while (reports.next()) {
      revisions.insert(reports->scene_revision);
      EXPECT_FALSE(reports.check().other_daemon);
      EXPECT_EQ(reports.check().missed, 0u);
      const clearance_msg_PairDistance* const found = pair.in(*reports);
      without += found == nullptr;
      if (found == nullptr) continue;
      ids.insert(found->pair);
      wrong += names.pair_name(*found, reports->scene_revision) != "right - floor";
    }
  };
  ASSERT_TRUE(eventually([&] {
    follow();
    return !ids.empty();
  }));
  without = 0;
  const auto reorder = [&](const std::string& changed) {
    reload(changed);
    const std::uint64_t expected = cell.cell().scene.revision;
    ASSERT_TRUE(eventually([&] { return follow(), revisions.contains(expected); }));
    for (int i = 0; i < 20; ++i) follow();
  };
  const std::string right = "  - {name: right, groups: [arm], box: {size: [0.2, 0.3, 0.2]}}\n";
  reorder(replaced(replaced(text, right, ""), "objects:\n", "objects:\n" + right));
  reorder(replaced(text, "  - {name: floor,",
                   "  - {name: wall, fixed: true, groups: [still], pose: {xyz: [0, 5, 0]}, box: "
                   "{size: [1, 1, 1]}}\n  - {name: floor,"));
  reorder(text);
  EXPECT_EQ(revisions.size(), 3u);
  EXPECT_GE(ids.size(), 2u);
  EXPECT_EQ(wrong, 0u);
  EXPECT_LE(without, 6u) << "reports that overtook their catalogue";
}

}  // namespace
}  // namespace clearance::test
