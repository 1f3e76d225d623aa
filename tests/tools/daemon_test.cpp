// clearanced itself, started as a user starts it, with real DDS on loopback.
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <sstream>

#include "monitor/files/build_info.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/shared/places.hpp"
#include "tests/tools/running_cell.hpp"

namespace clearance {
namespace {

using test::ChildProcess;
using test::eventually;

using Reports = std::vector<std::unique_ptr<Sample<clearance_msg_Distances>>>;

std::uint64_t last_used(const clearance_msg_Distances& report) {
  return report.sources._length == 0 ? 0 : report.sources._buffer[0].sequence_number;
}

// Sends `count` batches. Each one is sent after a report that used the previous one; the function
// returns after a report that used the last.
Reports run_in_step(test::Poses& poses, test::Distances& distances, std::size_t count) {
  Reports reports;
  std::uint64_t used = 0;
  while (used < count) {
    reports.push_back(distances.next());
    if (reports.back() == nullptr) {
      ADD_FAILURE() << "no report came after " << reports.size() - 1;
      return {};
    }
    used = std::max(used, last_used(**reports.back()));
    const std::size_t sent = poses.sent().size();
    if (sent < count && used == sent) poses.send(0.01 * static_cast<double>(sent));
  }
  return reports;
}

void expect_same_pair(const PairReport& offline, const clearance_msg_PairDistance& online,
                      std::uint64_t cycle) {
  EXPECT_EQ(online.pair, offline.pair) << "cycle " << cycle;
  EXPECT_EQ(online.status, static_cast<std::uint8_t>(offline.status)) << "cycle " << cycle;
  // Any two correct runs have overlapping bounds; the same build gives the same bits.
  EXPECT_LE(online.lower, offline.upper) << "cycle " << cycle;
  EXPECT_GE(online.upper, offline.lower) << "cycle " << cycle;
  if (offline.status == PairStatus::kUnknown) return;
  EXPECT_EQ(online.distance, offline.distance) << "cycle " << cycle;
  EXPECT_EQ(online.lower, offline.lower) << "cycle " << cycle;
  EXPECT_EQ(online.upper, offline.upper) << "cycle " << cycle;
  EXPECT_EQ(online.witness_a.x, offline.witness_a.x()) << "cycle " << cycle;
  EXPECT_EQ(std::isnan(online.closing_speed), std::isnan(offline.closing_speed));
  if (std::isnan(offline.closing_speed)) return;  // a pose was late
  EXPECT_EQ(online.closing_speed, offline.closing_speed) << "cycle " << cycle;
}

// Calls Monitor::tick with the inputs that each report names as used.
void expect_offline_run_agrees(const Scene& scene, const std::vector<PoseBatch>& sent,
                               const Reports& reports) {
  Monitor monitor(scene);
  const clearance_msg_Distances& first = **reports.front();
  // Before the first received report there were no poses, so only the count of cycles matters.
  for (std::uint64_t cycle = 1; cycle < first.cycle; ++cycle) monitor.tick({}, first.now_ns);
  std::uint64_t used = 0;
  for (const auto& report : reports) {
    const clearance_msg_Distances& online = **report;
    std::vector<PoseSample> samples;
    for (; used < last_used(online); ++used) {
      samples.insert(samples.end(), sent[used].samples.begin(), sent[used].samples.end());
    }
    const Report& offline = monitor.tick(samples, online.now_ns);
    ASSERT_EQ(online.cycle, offline.cycle) << "a tick is missing";
    EXPECT_EQ(online.minimum_known, offline.minimum_known);
    EXPECT_EQ(online.minimum_certified, offline.minimum_certified);
    EXPECT_EQ(online.newest_pose_ns, offline.newest_pose_ns);
    if (offline.minimum_known) expect_same_pair(offline.minimum, online.minimum, online.cycle);
    ASSERT_EQ(online.pairs._length, offline.pairs.size());
    for (std::uint32_t i = 0; i < online.pairs._length; ++i) {
      expect_same_pair(offline.pairs[i], online.pairs._buffer[i], online.cycle);
    }
  }
  EXPECT_EQ(used, sent.size());
}

void expect_daemon_agrees_with_offline_run(const std::string& cell, std::size_t batches) {
  const Cell read = std::get<Cell>(read_cell(cell));
  const DdsOptions dds = test::own_dds();
  Participant client(dds);
  test::Poses poses(client, read);
  test::Distances distances(client, read);
  ChildProcess daemon(test::kDaemon, test::with({cell}, test::dds_arguments(dds)));
  ASSERT_TRUE(eventually([&] {
    return test::matched_readers(poses.writer()) == 1 &&
           test::matched_writers(distances.reader()) == 1;
  })) << daemon.output();
  ASSERT_TRUE(test::meets_writers_of(client, daemon)) << daemon.output();
  distances.settle();
  const Reports reports = run_in_step(poses, distances, batches);
  ASSERT_FALSE(reports.empty()) << daemon.output();
  EXPECT_TRUE((*reports.back())->minimum_known);
  expect_offline_run_agrees(read.scene, poses.sent(), reports);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
}

TEST(Daemon, EveryReportIsWhatAnOfflineRunOfTheSameStreamGives) {
  const test::CellFile cell(test::small_cell("small"));
  expect_daemon_agrees_with_offline_run(cell.path(), 100);
}

// The rate is 200 Hz, so that a sanitizer on a busy machine keeps up with every report.
TEST(Daemon, AgreesWithTheOfflineRunOnAShippedCell) {
  std::ostringstream text;
  text << std::ifstream(test::places::sources() + "/config/cells/mcintyre.yaml").rdbuf();
  const std::string rate = "rate_hz: 1000";
  std::string slow = text.str();
  ASSERT_NE(slow.find(rate), std::string::npos);
  const test::CellFile cell(slow.replace(slow.find(rate), rate.size(), "rate_hz: 200"));
  expect_daemon_agrees_with_offline_run(cell.path(), 200);
}

TEST(Daemon, EndsWithStatusZeroAndASummaryOnEitherSignal) {
  const test::CellFile cell(test::small_cell("small"));
  for (const int signal : {SIGTERM, SIGINT}) {
    ChildProcess daemon(test::kDaemon,
                        test::with({cell.path()}, test::dds_arguments(test::own_dds())));
    ASSERT_TRUE(daemon.tells("started", {"'small'"})) << daemon.output();
    daemon.signal(signal);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
    EXPECT_TRUE(daemon.tells("stopped", {" tick"})) << daemon.output();
    EXPECT_TRUE(daemon.wrote(" reports dropped")) << daemon.output();
    EXPECT_TRUE(daemon.wrote("minimum  none")) << daemon.output();
  }
}

TEST(Daemon, SaysWhyAZoneWasEntered) {
  const std::string far = "enter_below: 0.3, leave_above: 0.35";
  std::string text = test::small_cell("small");
  ASSERT_NE(text.find(far), std::string::npos);
  const test::CellFile cell(
      text.replace(text.find(far), far.size(), "enter_below: 0.6, leave_above: 0.65"));
  const Cell read = cell.cell();
  const DdsOptions dds = test::own_dds();
  Participant client(dds);
  test::Poses poses(client, read);
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, test::dds_arguments(dds)));
  EXPECT_TRUE(daemon.tells("zone-unknown", {"'near'", "left - right"}));
  // The poses are sent repeatedly, because the bodies may have moved a few milliseconds after a
  // pose.
  EXPECT_TRUE(eventually([&] {
    poses.send(0.0);  // 0.8 m apart
    return daemon.told("zone-left", {"'near'"});
  })) << daemon.output();
  EXPECT_TRUE(eventually([&] {
    poses.send(0.125);  // 0.57 m
    return daemon.told("zone-near", {"left - right, at least 0."});
  })) << daemon.output();
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();
}

TEST(Daemon, SaysOnceThatASourceIsSlowerThanTheAgeLimit) {
  const test::CellFile cell(test::small_cell("small", 20));
  const auto dds = test::dds_arguments(test::own_dds());
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, dds));
  ChildProcess robot(test::kRobot, test::with({cell.path(), "--rate", "20"}, dds));
  EXPECT_TRUE(daemon.tells("slow-input", {"20 ms", "age_limit_ms of 1"})) << daemon.output();
}

TEST(Daemon, EndsByItselfAfterTheTicksAskedFor) {
  const test::CellFile cell(test::small_cell("small"));
  ChildProcess daemon(test::kDaemon, test::with({cell.path(), "--ticks", "7"},
                                                test::dds_arguments(test::own_dds())));
  EXPECT_EQ(daemon.wait(), 0);
  EXPECT_TRUE(daemon.wrote("7 ticks in ")) << daemon.output();
}

TEST(Daemon, DoesNotHearAnotherDaemonsCell) {
  const test::CellFile cell_a(test::small_cell("one")), cell_b(test::small_cell("two"));
  const Cell read_a = cell_a.cell(), read_b = cell_b.cell();
  const DdsOptions dds_a = test::own_dds(), dds_b = test::own_dds();  // one domain, two partitions
  ASSERT_EQ(dds_a.domain, dds_b.domain);
  Participant client_a(dds_a), client_b(dds_b);
  test::Poses poses_a(client_a, read_a);
  test::Distances distances_a(client_a, read_a), distances_b(client_b, read_b);
  ChildProcess daemon_a(test::kDaemon, test::with({cell_a.path()}, test::dds_arguments(dds_a)));
  ChildProcess daemon_b(test::kDaemon, test::with({cell_b.path()}, test::dds_arguments(dds_b)));
  ASSERT_TRUE(eventually([&] {
    return test::matched_readers(poses_a.writer()) == 1 &&
           test::matched_writers(distances_a.reader()) == 1 &&
           test::matched_writers(distances_b.reader()) == 1;
  }));
  ASSERT_TRUE(test::meets_writers_of(client_a, daemon_a)) << daemon_a.output();
  const Reports reports_a = run_in_step(poses_a, distances_a, 20);
  ASSERT_FALSE(reports_a.empty());
  for (const auto& report : reports_a) EXPECT_EQ((*report)->scene_revision, read_a.scene.revision);
  for (int i = 0; i < 20; ++i) {
    const auto report = distances_b.next();
    ASSERT_NE(report, nullptr);
    EXPECT_EQ((*report)->scene_revision, read_b.scene.revision);
    EXPECT_FALSE((*report)->minimum_known) << "poses for one cell reached the other";
  }
}

TEST(Daemon, IsNotHeldUpByAClientThatStopped) {
  const test::CellFile cell(test::small_cell("small"));
  const Cell read = cell.cell();
  const DdsOptions dds = test::own_dds();
  Participant client(dds);
  test::Poses poses(client, read);
  test::Distances distances(client, read);
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, test::dds_arguments(dds)));
  ChildProcess stopped(test::kWatch, test::with({"--plain"}, test::dds_arguments(dds)));
  ASSERT_TRUE(eventually([&] { return stopped.wrote("cycle "); })) << stopped.output();
  stopped.signal(SIGSTOP);
  ASSERT_TRUE(eventually([&] { return test::matched_readers(poses.writer()) == 1; }));
  ASSERT_TRUE(test::meets_writers_of(client, daemon)) << daemon.output();
  distances.settle();
  // More reports than any buffer between the daemon and the stopped client can hold.
  const Reports reports = run_in_step(poses, distances, 300);
  ASSERT_FALSE(reports.empty());
  for (std::size_t i = 1; i < reports.size(); ++i) {
    ASSERT_EQ((*reports[i])->cycle, (*reports[i - 1])->cycle + 1);
  }
  stopped.signal(SIGCONT);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
  EXPECT_TRUE(daemon.wrote(" 0 reports dropped")) << daemon.output();
}

TEST(DaemonCommand, ChecksACellWithoutRunningIt) {
  const test::CellFile cell(test::small_cell("small"));
  ChildProcess good(test::kDaemon, {cell.path(), "--check"});
  EXPECT_EQ(good.wait(), 0);
  EXPECT_TRUE(good.wrote("small: 3 objects")) << good.output();
}

TEST(DaemonCommand, NamesEveryErrorOfABadCell) {
  const test::CellFile cell("name: bad\nunits: {length: m, angle: deg}\nrate_hz: -1\nobjets: []\n");
  for (const auto& arguments : {std::vector<std::string>{cell.path(), "--check"}, {cell.path()}}) {
    ChildProcess bad(test::kDaemon, arguments);
    EXPECT_EQ(bad.wait(), 3);
    EXPECT_TRUE(bad.wrote(cell.path() + ":3:")) << bad.output();
    EXPECT_TRUE(bad.wrote(cell.path() + ":4:")) << bad.output();
  }
  ChildProcess missing(test::kDaemon, {"/nonexistent/cell.yaml", "--check"});
  EXPECT_EQ(missing.wait(), 3);
  EXPECT_TRUE(missing.wrote("/nonexistent/cell.yaml")) << missing.output();
}

TEST(DaemonCommand, SaysWhatIsWrongWithHowItIsCalled) {
  ChildProcess help(test::kDaemon, {"--help"});
  EXPECT_EQ(help.wait(), 0);
  EXPECT_TRUE(help.wrote("Example:")) << help.output();
  EXPECT_TRUE(help.wrote("Wake this many us (1 to 500)")) << help.output();
  ChildProcess nothing(test::kDaemon, {});
  EXPECT_EQ(nothing.wait(), 2);
  ChildProcess unknown(test::kDaemon, {"cell.yaml", "--nosuchoption"});
  EXPECT_EQ(unknown.wait(), 2);
  ChildProcess both(test::kDaemon, {"--nosuchoption"});
  EXPECT_EQ(both.wait(), 2);
  EXPECT_TRUE(both.wrote("--nosuchoption")) << both.output();
  EXPECT_TRUE(both.wrote("[CELL,--urdf,--robot-description] is required")) << both.output();
  ChildProcess peer(test::kDaemon, {"cell.yaml", "--peer", "not an address"});
  EXPECT_EQ(peer.wait(), 2);
  EXPECT_TRUE(peer.wrote("'not an address'")) << peer.output();
  for (const char* option : {"--ticks", "--cpu"}) {
    ChildProcess negative(test::kDaemon, {"cell.yaml", option, "-5"});
    EXPECT_EQ(negative.wait(), 2);
    EXPECT_TRUE(negative.wrote("found '-5'; expected a whole number from 0 to ")) << option;
  }
  ChildProcess ahead(test::kDaemon, {"cell.yaml", "--ahead", "50"});
  EXPECT_EQ(ahead.wait(), 2);
  EXPECT_TRUE(ahead.wrote("--priority")) << ahead.output();
  ChildProcess version(test::kDaemon, {"--version"});
  EXPECT_EQ(version.wait(), 0);
  EXPECT_TRUE(version.wrote(std::string("clearance ") + kBuild)) << version.output();
  const test::CellFile cell(test::small_cell("small"));
  ChildProcess interface(test::kDaemon, {cell.path(), "--interface", "nosuch0"});
  EXPECT_EQ(interface.wait(), 4);
  EXPECT_TRUE(interface.wrote("domain")) << interface.output();
}

TEST(Daemon, TellsAClientWithoutANameOfItsOwnUnderWhichOneItMaySend) {
  const test::CellFile cell(test::small_cell("small"));
  const std::vector<std::string> dds = test::dds_arguments(test::own_dds());
  ChildProcess daemon(test::kDaemon, test::with({cell.path(), "--commands", "planner"}, dds));
  const std::vector<std::string> change = {"send", "--change", "set_margin: {object: left}"};
  ChildProcess stranger(test::kScene, test::with(change, dds));
  EXPECT_EQ(stranger.wait(), 6) << stranger.output();
  EXPECT_TRUE(stranger.wrote("found a request of 'clearance-scene'; expected 'planner'") &&
              stranger.wrote("--as NAME sends under another name"))
      << stranger.output();
  ChildProcess planner(test::kScene, test::with(test::with(change, {"--as", "planner"}), dds));
  EXPECT_EQ(planner.wait(), 0) << planner.output();
}

// The option goes first, then the cell, then the variable.
TEST(Daemon, JoinsTheDomainOfRosUnlessAnOptionOrTheCellStatesOne) {
  const std::string id = std::to_string(*test::own_dds().domain), other = "101";
  const test::CellFile silent(test::small_cell("silent"));
  const test::CellFile stated(test::small_cell("stated") + "dds: {domain: " + id + "}\n");
  const auto started = [](const test::CellFile& cell, const std::string& of_ros,
                          const std::vector<std::string>& options, const std::string& domain) {
    std::vector<std::string> line = {cell.path(), "--partition", test::own_dds().partition,
                                     "--ticks", "1"};
    line.insert(line.end(), options.begin(), options.end());
    ChildProcess daemon(test::kDaemon, line, {.environment = {{"ROS_DOMAIN_ID", of_ros}}});
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
    EXPECT_TRUE(daemon.tells("started", {"on domain " + domain})) << daemon.output();
  };
  started(silent, id, {}, id + " (of ROS_DOMAIN_ID), ");
  started(stated, other, {}, id + ", ");
  started(silent, other, {"--domain", id}, id + ", ");
  started(stated, "nonsense", {}, id + ", ");
  ChildProcess refused(test::kDaemon, {silent.path()}, {.environment = {{"ROS_DOMAIN_ID", "x"}}});
  EXPECT_EQ(refused.wait(), 4);
  EXPECT_TRUE(refused.wrote("found ROS_DOMAIN_ID='x'; expected a domain, 0 to 232"))
      << refused.output();
}

}  // namespace
}  // namespace clearance
