// The shares of a cell as processes: daemons of one share each, clients that join them, and what
// becomes of a share that is killed, stopped, or has another revision.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "config/cell/cell_file.hpp"
#include "config/cell/share_topics.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/wire/report_checksum.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
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
using test::write_text;

TEST_F(SharedCells, AreOneReportWithTheBoundsOfOneDaemonOfTheWholeCell) {
  start_all();
  client::SharedCell whole(connection, {.late_after = milliseconds(500)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole() && whole->minimum_certified; }))
      << logs() << whole.what_is_missing();
  ASSERT_EQ(whole->pairs._length, cell.scene.pairs.size());
  // The objects' poses are those of ticks that are less than two periods apart, and each share's
  // bounds are true of them: the distances of any two shares fit the motion.
  double least = kInfinity;
  for (std::uint32_t i = 0; i < whole->pairs._length; ++i) {
    const clearance_msg_PairDistance& pair = whole->pairs._buffer[i];
    EXPECT_EQ(pair.pair, i);
    EXPECT_NE(pair.status, kUnknown);
    least = std::min(least, pair.upper);
  }
  EXPECT_EQ(whole->minimum.upper, least);
  EXPECT_EQ(whole->pairs_total, 3u);
  EXPECT_EQ(whole->scene_revision, cell.scene.revision);
  ASSERT_TRUE(whole.zones().contains(0));
  const std::uint64_t before = whole->cycle;
  bool is_active = false, is_clear = false;
  EXPECT_TRUE(read_until(whole, [&] {
    (whole.zones().at(0).active ? is_active : is_clear) = true;
    return is_active && is_clear;
  })) << logs();
  EXPECT_GT(whole->cycle, before);
  EXPECT_EQ(whole.missed(), 0u);
}

TEST_F(SharedCells, AKilledOneIsUnknownByNameAndComesBack) {
  start_all();
  client::SharedCell whole(connection, {.late_after = milliseconds(300)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  for (const bool is_stopped : {false, true}) {
    SCOPED_TRACE(is_stopped);
    daemons["boxes"]->signal(is_stopped ? SIGSTOP : SIGKILL);
    // Until it is unknown, no report is older than that limit.
    EXPECT_TRUE(read_until(whole, [&] {
      EXPECT_TRUE(status(whole, 0) == kUnknown || dds_time() - whole->publish_ns < 1'000'000'000);
      return !whole.is_whole();
    }));
    EXPECT_NE(whole.what_is_missing().find("'boxes'"), std::string::npos);
    EXPECT_EQ(std::ranges::count(whole.shares(), ShareState::kWhole, &client::ShareCheck::state),
              2);
    EXPECT_EQ(whole->lower_all, -kInfinity);
    EXPECT_FALSE(whole->minimum_certified);
    const std::uint32_t boxes = cell.shares.all[0].pairs[0];
    for (std::uint32_t pair = 0; pair < 3; ++pair)
      EXPECT_EQ(status(whole, pair) == kUnknown, pair == boxes);
    EXPECT_TRUE(whole.zones().at(0).active);
    EXPECT_EQ(whole.zones().at(0).cause, static_cast<std::uint8_t>(ZoneCause::kNoShare));
    const auto health = whole.health();
    ASSERT_EQ(health->shares._length, 3u);
    EXPECT_STREQ(health->shares._buffer[0].share, "boxes");
    EXPECT_NE(health->shares._buffer[0].state, 0);
    EXPECT_EQ(health->shares._buffer[1].state, 0);
    if (is_stopped) {
      daemons["boxes"]->signal(SIGCONT);
    } else {
      start("boxes");
    }
    // The first tick may come before its first poses.
    EXPECT_TRUE(read_until(whole, [&] {
      return whole.is_whole() && status(whole, boxes) != kUnknown;
    })) << logs();
  }
  for (const auto& [name, daemon] : daemons) daemon->signal(SIGKILL);
  EXPECT_TRUE(read_until(whole, [&] { return whole->unknown == 3; }));
  EXPECT_TRUE(whole.zones().at(0).active) << "without any share, nothing is clear";
}

TEST_F(SharedCells, DaemonsOfDifferentOnesAreNoRivalsAndTwoOfTheSameAre) {
  start_all();
  client::SharedCell whole(connection, {.late_after = milliseconds(500)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  ChildProcess& second = start("boxes", {}, "second");
  EXPECT_EQ(second.wait(), 4) << second.output();
  EXPECT_TRUE(second.tells("other-daemon-first")) << second.output();
  EXPECT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  for (const Share& share : cell.shares.all) EXPECT_TRUE(daemons[share.name]->running());
}

TEST_F(SharedCells, PartnersOfAShareLoseNoCycleWhenOneIsKilled) {
  for (const Share& share : cell.shares.all) start(share.name, {"--partner", "one"});
  client::SharedCell whole(connection, {.late_after = milliseconds(500)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  ChildProcess& second = start("boxes", {"--partner", "two"}, "second");
  ASSERT_TRUE(second.tells("partner-agrees")) << logs();
  read_until(
      whole, [] { return false; }, 1);
  const std::uint64_t missed = whole.missed();
  const std::uint64_t cycle = whole->cycle;
  daemons["boxes"]->signal(SIGKILL);
  EXPECT_TRUE(read_until(whole, [&] {
    EXPECT_TRUE(whole.is_whole()) << whole.what_is_missing();
    return whole->cycle > cycle + 200;
  })) << logs();
  // Late ticks lose cycles, too. Daemons tell of them once per second.
  const auto ran_over = [this] { return logs().find("[overruns]") != std::string::npos; };
  if (whole.missed() != missed) read_until(whole, ran_over, 2);
  EXPECT_TRUE(whole.missed() == missed || ran_over()) << whole.missed() - missed << logs();
}

// The cell names one partner of each share, and the option the other one.
class SharedCellsOfPartners : public SharedCells {
 protected:
  SharedCellsOfPartners() : SharedCells("partner: one\n") {}
};

TEST_F(SharedCellsOfPartners, MayBeNamedByTheCell) {
  start_all();
  client::SharedCell whole(connection, {.late_after = milliseconds(500)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  ChildProcess& second = start("boxes", {"--partner", "two"}, "second");
  EXPECT_TRUE(second.tells("partner-agrees", {"one"})) << logs();
}

TEST_F(SharedCells, OfAnotherRevisionAreUnknownUntilTheyAgree) {
  start_all();
  client::SharedCell whole(connection, {.late_after = milliseconds(500)});
  ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  std::ofstream(file.path(), std::ios::app) << "# another text\n";
  daemons["left floor"]->signal(SIGHUP);
  EXPECT_TRUE(read_until(whole, [&] { return !whole.is_whole(); })) << logs();
  EXPECT_EQ(whole.shares()[1].state, ShareState::kOtherRevision) << whole.what_is_missing();
  EXPECT_EQ(whole->scene_revision, cell.scene.revision) << "two of three have it";
  EXPECT_EQ(whole->lower_all, -kInfinity);
  daemons["boxes"]->signal(SIGHUP);
  daemons["right floor"]->signal(SIGHUP);
  EXPECT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  EXPECT_NE(whole->scene_revision, cell.scene.revision);
}

TEST_F(SharedCells, AnUnknownNameEndsTheDaemonWithTheNamesThatThereAre) {
  ChildProcess& daemon = start("boxen");
  EXPECT_EQ(daemon.wait(), 3);
  EXPECT_TRUE(daemon.wrote("'left floor'")) << daemon.output();
}

// Readers that know nothing of shares see one daemon.
TEST_F(SharedCells, AreOneDaemonToOrdinaryReadersBehindClearanceMerge) {
  start_all();
  ChildProcess watch(test::kWatch, test::with({"--plain"}, test::dds_arguments(dds)));
  EXPECT_TRUE(test::eventually([&] {
    return watch.wrote("waiting for clearance-merge") && watch.wrote("'boxes', 'left_floor'");
  })) << watch.output();
  ChildProcess merge(kMerge,
                     test::with({file.path(), "--late-ms", "300"}, test::dds_arguments(dds)));
  client::Reports reports(connection);
  client::Catalogue catalogue(connection);
  client::Pair boxes(catalogue, "left", "right");
  client::Zones zones(connection);
  client::Health health(connection);
  const auto hears = [&](const auto& is_so) {
    return test::eventually([&] {
      const bool came = reports.next(milliseconds(50));
      zones.update();
      health.update();
      return came && is_so();
    });
  };
  ASSERT_TRUE(hears([&] {
    const auto* const pair = boxes.in(*reports);
    return pair != nullptr && pair->status != kUnknown && reports->minimum_certified;
  })) << merge.output()
      << logs();
  EXPECT_TRUE(reports.check().fresh());
  EXPECT_EQ(reports->pairs._length, 3u);
  // The daemons tell their health once per second.
  ASSERT_TRUE(hears([&] {
    return health.message() != nullptr && health.message()->inputs._length == 2 &&
           zones.states().contains(0);
  }));
  EXPECT_EQ(health.message()->shares._length, 3u);
  daemons["boxes"]->signal(SIGKILL);
  EXPECT_TRUE(hears([&] {
    return boxes.in(*reports)->status == kUnknown && zones.states().at(0).active &&
           zones.states().at(0).cause == static_cast<std::uint8_t>(ZoneCause::kNoShare);
  })) << merge.output();
  EXPECT_TRUE(test::eventually([&] {
    return merge.told("share-late", {"boxes"}) || merge.told("share-missing", {"boxes"});
  })) << merge.output();
  EXPECT_TRUE(test::eventually([&] {
    return watch.wrote("not certified  1 of 3 pairs unknown  share 'boxes' is ");
  })) << watch.output();
  start("boxes");
  EXPECT_TRUE(hears([&] { return boxes.in(*reports)->status != kUnknown; })) << merge.output();
  merge.signal(SIGTERM);
  EXPECT_EQ(merge.wait(), 0) << merge.output();
  EXPECT_FALSE(merge.wrote(" 0 zones active without a share")) << merge.output();
  EXPECT_TRUE(merge.wrote(", 0 zones wrong")) << merge.output();
}

// A report may come before the catalogue of its scene.
TEST_F(SharedCells, SayNothingBeforeTheNamesOfASceneAreKnown) {
  client::SharedCellOptions options;
  for (const Share& share : cell.shares.all) options.names.push_back(share.name);
  client::SharedCell whole(connection, options);
  Participant boxes(dds);
  const dds_entity_t writer =
      boxes.writer(TopicKind::kDistances, share_topic(cell.topics.distances, "boxes"));
  ASSERT_TRUE(test::eventually([&] { return test::matched_readers(writer) == 1; }));
  Sample<clearance_msg_Distances> report;
  report->daemon = 1;
  report->scene_revision = cell.scene.revision;
  for (report->cycle = 1; report->cycle < 30; ++report->cycle) {
    report->now_ns = report->publish_ns = dds_time();
    seal(*report, boxes.address(share_topic(cell.topics.distances, "boxes")));
    ASSERT_EQ(dds_write(writer, &*report), DDS_RETCODE_OK);
    EXPECT_FALSE(whole.next(milliseconds(5)));
  }
}

// One joint moves the finger past a pin. The gradient of each pair comes from the share that has
// it.
TEST(SharedGradients, AreThoseOfAllSharesAndClearanceMergeWritesThem) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", test::kScaraUrdf);
  write_text(folder / "cell.yaml",
             "name: gradients\nunits: {length: m, angle: rad}\nrate_hz: 100\ngradients: true\n"
             "defaults: {age_limit_ms: 10000}\nrobots: [{name: arm, urdf: scara.urdf}]\nobjects:\n"
             "  - {name: pin, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [2.3, 0, 0]}}\n"
             "pairs:\n  - {between: [arm, pin], publish: true}\n"
             "  - {between: [finger, foot], publish: true}\nshares:\n"
             "  - {name: hand, pairs: [{between: [finger, pin]}, {between: [finger, foot]}]}\n"
             "  - {name: rest, pairs: [{between: [upper, pin]}, {between: [lower, pin]}]}\n");
  const std::string file = (folder / "cell.yaml").string();
  const Cell cell = std::get<Cell>(read_cell(file));
  const DdsOptions dds = test::own_dds();
  client::Connection connection(dds, cell.topics);
  const auto arguments = test::dds_arguments(dds);
  ChildProcess hand(kDaemon, test::with({file, "--share", "hand"}, arguments));
  ChildProcess rest(kDaemon, test::with({file, "--share", "rest"}, arguments));
  ChildProcess merge(kMerge, test::with({file, "--late-ms", "500"}, arguments));
  client::JointWriter joints(connection, "driver",
                             std::vector<std::string>{"shoulder", "elbow", "push"});
  client::SharedCell whole(connection, {.late_after = milliseconds(500), .gradients = true});
  client::Gradients merged(connection);
  // The finger stands at (0, 2): the pin is at its right, and nearer if the shoulder turns back.
  const auto are_right = [](const clearance_msg_Gradients& gradients) {
    const double rate = 2.0 * 2.3 / std::hypot(2.0, 2.3);
    bool is_right = false;
    for (std::uint32_t i = 0; i < gradients.pairs._length; ++i) {
      const clearance_msg_PairGradient& pair = gradients.pairs._buffer[i];
      is_right = is_right ||
                 (pair.joints._length == 3 && std::abs(pair.joints._buffer[0].rate - rate) < 1e-6);
    }
    return is_right && gradients.pairs._length == 4 && gradients.alternatives._length == 4;
  };
  EXPECT_TRUE(test::eventually([&] {
    joints.write(std::vector{1.5707963267948966, 0.0, 0.0}, std::vector{0.0, 0.0, 0.0});
    return whole.newest(milliseconds(20)) && whole.gradients() != nullptr &&
           are_right(*whole.gradients());
  })) << hand.output()
      << rest.output();
  EXPECT_TRUE(test::eventually([&] {
    joints.write(std::vector{1.5707963267948966, 0.0, 0.0}, std::vector{0.0, 0.0, 0.0});
    return merged.newest(milliseconds(20)) && are_right(*merged);
  })) << merge.output();
}

// The demonstration: two partners of each of three shares, one of them killed now and then.
TEST(Several, LosesNoCycleAndHasNoZoneWrong) {
  const DdsOptions dds = test::own_dds();
  ChildProcess several(test::places::sources() + "/tools/several",
                       {test::places::programs(), "--seconds", "4", "--every", "1", "--rate", "50",
                        "--late-ms", "1000", "--domain", std::to_string(*dds.domain)});
  const int status = several.wait();
  const std::string text = several.output();
  // A share loses a cycle where the partner that lives is late, which it tells.
  const auto number_before = [&text](const std::string& words) {
    const std::size_t end = text.find(words), begin = text.find_last_of(" \n", end - 1) + 1;
    return end == std::string::npos ? -1 : std::stoi(text.substr(begin, end - begin));
  };
  const int lost = number_before(" cycles lost, 0 zones active without a share, 0 zones wrong");
  const int late = number_before(" late or skipped ticks");
  EXPECT_TRUE(lost >= 0 && lost <= late) << text;
  EXPECT_EQ(status, lost == 0 ? 0 : 1) << text;
  for (const char* complaint : {"No such file", "syntax error", "has not logged"})
    EXPECT_FALSE(several.wrote(complaint)) << text;
}

}  // namespace
}  // namespace clearance
