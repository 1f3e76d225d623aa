// clearance-view as people and programs use it: in a browser, and through Foxglove's own client.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "monitor/recording/reader.hpp"
#include "monitor/wire/cdr.hpp"
#include "tests/monitor/scara_cell.hpp"
#include "tests/shared/ros_frames.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance {
namespace {

using nlohmann::json;
using test::ChildProcess;
using test::eventually;
using test::kView;
using test::lines_of;
using test::View;

const std::string kScripts = CLEARANCE_VIEW_JS;

// A folder in the build for pictures that are kept after the run.
std::string pictures() {
  const std::filesystem::path folder = CLEARANCE_VIEW_PICTURES;
  std::filesystem::create_directories(folder);
  return folder.string();
}

// Waits until the daemon has poses of both boxes.
void wait_for_poses(const DdsOptions& dds, const Cell& cell) {
  Participant client(dds);
  test::Distances reports(client, cell);
  for (;;) {
    const auto report = reports.next();
    ASSERT_NE(report, nullptr);
    if ((*report)->minimum_known && (*report)->unknown == 0) return;
  }
}

const std::string kTwoArms = std::string(CLEARANCE_SOURCE) + "/config/cells/two_arms.yaml";

class ViewOfARecording : public testing::Test {
 protected:
  ViewOfARecording() {
    const DdsOptions own = test::own_dds();
    const auto dds = test::dds_arguments(own);
    ChildProcess daemon(test::kDaemon, test::with({cell.path(), "--record", file}, dds));
    ChildProcess robot(test::kRobot, test::with({cell.path(), "--rate", "200"}, dds));
    wait_for_poses(own, cell.cell());
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  }

  // The entry with the least distance that is not stale.
  [[nodiscard]] clearance_msg_PairDistance worst() const {
    RecordingReader reader(file);
    RecordedMessage message;
    CdrDecoder decoder;
    Sample<clearance_msg_Distances> report;
    clearance_msg_PairDistance least{};
    least.distance = kInfinity;
    while (reader.next(message)) {
      if (message.kind != TopicKind::kDistances || !decoder.decode(message.cdr, report)) continue;
      const auto& minimum = report->minimum;
      if (!report->minimum_known || minimum.status >= 5) continue;
      if (minimum.distance < least.distance) least = minimum;
    }
    return least;
  }

  test::CellFile cell{test::small_cell("small")};
  test::ScratchFolder folder;
  std::string file = (folder / "run.mcap").string();
};

TEST(View, ShowsInABrowserWhatTheTopicSaysAndThatTheDaemonHasEnded) {
  const DdsOptions dds = test::own_dds();
  const auto arguments = test::dds_arguments(dds);
  const Cell cell = std::get<Cell>(read_cell(kTwoArms));
  Participant client(dds);
  ChildProcess daemon(test::kDaemon, test::with({kTwoArms}, arguments));
  ChildProcess robot(test::kRobot, test::with({kTwoArms, "--rate", "250"}, arguments));
  View view(test::with({kTwoArms}, arguments));
  test::Distances reports(client, cell);
  ChildProcess page("/usr/bin/env",
                    {"node", kScripts + "/page.mjs", view.page(), pictures(), "live"});
  std::map<std::uint64_t, double> distances;  // by cycle
  const auto hear = [&] {
    const auto report = reports.next();
    if (report != nullptr) distances[(*report)->cycle] = (*report)->minimum.distance;
    return report != nullptr;
  };
  while (page.running() && lines_of(page).empty()) ASSERT_TRUE(hear());
  ASSERT_EQ(lines_of(page).size(), 1u) << page.output();
  const json shown = lines_of(page).front();
  EXPECT_EQ(shown["errors"], json::array());
  ASSERT_EQ(shown["samples"].size(), 10u) << page.output();
  // On a busy machine, the page may have received a report before this loop.
  while (distances.rbegin()->first < shown["samples"].back()["cycle"]) ASSERT_TRUE(hear());
  int compared = 0;
  for (const json& sample : shown["samples"]) {
    const auto known = distances.find(sample["cycle"]);
    if (known == distances.end() || sample["distance"].is_null()) continue;
    EXPECT_EQ(known->second, sample["distance"].get<double>()) << sample;
    ++compared;
  }
  EXPECT_GE(compared, 1);  // on a busy machine the page or this loop skips reports
  EXPECT_EQ(shown["chosen"], 1);
  EXPECT_GT(shown["rows"], 100);
  EXPECT_EQ(shown["zones"].size(), cell.scene.zones.size());
  EXPECT_EQ(shown["theme"], "dark");
  EXPECT_THAT(shown["address"].get<std::string>(), testing::HasSubstr("pairs="));

  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0);
  EXPECT_EQ(page.wait(std::chrono::seconds(200)), 0) << page.output();
  const json ended = lines_of(page).back();
  EXPECT_TRUE(ended["frozen"]) << page.output();
  EXPECT_TRUE(ended["minimum"]["distance"].is_null());
  EXPECT_EQ(view.end(), 0);
}

// A person and a robot stand 1.7 m apart until the poses end.
TEST(View, ShowsHowMuchIsLeftBetweenAPersonAndARobot) {
  const test::CellFile cell(R"(name: hall
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: 300}
objects:
  - {name: person, sphere: {radius: 0.2}}
  - {name: robot, sphere: {radius: 0.1}}
pairs: [{between: [person, robot], publish: true}]
zones:
  - name: people
    between: [person, robot]
    enter_below: 0.3
    leave_above: 0.4
    separation: {human: person, reaction_time_ms: 100, stopping_time_ms: 250,
                 stopping_distance: 0.125, stopping_speed: 1, intrusion_distance: 0.1}
simulation:
  movers: [{object: person, centre: {xyz: [2, 0, 0]}}, {object: robot}]
)");
  const auto dds = test::dds_arguments(test::own_dds());
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, dds));
  ChildProcess robot(test::kRobot, test::with({cell.path(), "--rate", "200"}, dds));
  View view(test::with({cell.path()}, dds));
  std::filesystem::remove(pictures() + "/separation.png");
  ChildProcess page("/usr/bin/env",
                    {"node", kScripts + "/page.mjs", view.page(), pictures(), "separation"});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(pictures() + "/separation.png"); },
                         std::chrono::seconds(100)))
      << page.output();
  robot.signal(SIGTERM);
  EXPECT_EQ(page.wait(std::chrono::seconds(200)), 0) << page.output();
  ASSERT_EQ(lines_of(page).size(), 1u) << page.output();
  const json shown = lines_of(page).front();
  EXPECT_EQ(shown["errors"], json::array());
  const std::vector<std::string> measured = shown["measured"], lost = shown["lost"];
  ASSERT_EQ(measured.size(), 6u);
  EXPECT_EQ(measured[0], "people: person – robot");
  EXPECT_EQ(measured[1], "1700");  // mm
  // C, and the distance at 1.6 m/s during the robot's reaction and the age of the pose, up to the
  // age limit.
  const double protective = std::stod(measured[2]);
  EXPECT_GE(protective, 260.0);
  EXPECT_LE(protective, 260.0 + 1.6 * 300.0);
  EXPECT_NEAR(std::stod(measured[3]), 1700.0 - protective, 1.0);
  EXPECT_EQ(measured[4], "1.00");
  EXPECT_THAT(lost, testing::ElementsAre(measured[0], "?", "?", "?", "0.00", "0.00"));
}

TEST_F(ViewOfARecording, FindsTheWorstMomentAndGoesWhereItIsDragged) {
  View view({cell.path(), "--replay", file});
  ChildProcess page("/usr/bin/env",
                    {"node", kScripts + "/page.mjs", view.page(), pictures(), "recording"});
  EXPECT_EQ(page.wait(std::chrono::seconds(200)), 0) << page.output();
  const std::vector<json> said = lines_of(page);
  ASSERT_EQ(said.size(), 2u) << page.output();
  const json& shown = said.front();
  EXPECT_EQ(shown["errors"], json::array());
  EXPECT_EQ(shown["worst"]["distance"], worst().distance);
  EXPECT_EQ(shown["worst"]["pair"], "left – right");
  const double duration = shown["timeline"]["duration"];
  EXPECT_NEAR(shown["dragged"], 0.73 * duration, 0.05 * duration);
  EXPECT_EQ(shown["clicked"], "left");
  EXPECT_NEAR(shown["again"], shown["dragged"], 0.002);
  EXPECT_EQ(shown["chosen"], 1);
  EXPECT_GT(said.back()["played"], shown["dragged"]);
}

TEST_F(ViewOfARecording, SaysTheSameOfReportsThatItComputesItself) {
  View recorded({cell.path(), "--replay", file});
  View computed({cell.path(), "--replay", file, "--offline"});
  json found[2];
  for (int i = 0; i < 2; ++i) {
    const View& view = i == 0 ? recorded : computed;
    ChildProcess client("/usr/bin/env",
                        {"node", kScripts + "/foxglove.mjs", view.socket(), "time", "1"});
    EXPECT_EQ(client.wait(), 0) << client.output();
    const std::vector<json> said = lines_of(client);
    ASSERT_EQ(said.size(), 1u) << client.output();
    found[i] = said.front();
    EXPECT_EQ(found[i]["parameters"]["playback.time"], 1.0);
    EXPECT_FALSE(found[i]["parameters"]["playback.playing"]);
  }
  SCOPED_TRACE(found[0]["last"]["clearance/distances"]["minimum"].dump());
  EXPECT_EQ(found[0]["last"]["/tf"]["transforms"].size(), 3u);
  EXPECT_EQ(found[0]["last"]["/tf"]["transforms"], found[1]["last"]["/tf"]["transforms"]);
  const json &first = found[0]["last"]["clearance/distances"],
             &second = found[1]["last"]["clearance/distances"];
  EXPECT_EQ(first["cycle"], second["cycle"]);
  EXPECT_EQ(first["minimum"], second["minimum"]);
  EXPECT_EQ(first["pairs"], second["pairs"]);
}

// The content of the recording's reports and zones up to this time, s after the first report.
struct Before {
  std::uint64_t cycle = 0;
  bool zone_active = false;
  double least = kInfinity;          // m
  double least_of_pair = kInfinity;  // for pair 2
};
Before before(const std::string& file, double time_s) {
  RecordingReader reader(file);
  RecordedMessage message;
  CdrDecoder decoder;
  Sample<clearance_msg_Distances> report;
  Sample<clearance_msg_ZoneState> zone;
  Before found;
  std::int64_t begin_ns = 0;
  while (reader.next(message)) {
    if (begin_ns != 0 && message.log_ns > begin_ns + std::llround(1e9 * time_s)) break;
    if (message.kind == TopicKind::kZones && decoder.decode(message.cdr, zone)) {
      found.zone_active = zone->active;
    } else if (message.kind == TopicKind::kDistances && decoder.decode(message.cdr, report)) {
      if (begin_ns == 0) begin_ns = message.log_ns;
      found.cycle = report->cycle;
      if (!report->minimum_known || report->minimum.status >= 5) continue;
      found.least = std::min(found.least, report->minimum.distance);
      found.least_of_pair = std::min(found.least_of_pair, report->pairs._buffer[2].distance);
    }
  }
  return found;
}

double least_in(const json& curve) {
  double least = kInfinity;
  for (const json& value : curve) {
    if (!value.is_null()) least = std::min(least, value.get<double>());
  }
  return least;
}

// The jumps lead to times between ticks. A report less than a microsecond later counts as the one
// of that time.
TEST_F(ViewOfARecording, AJumpBringsTheZonesAndTheHistoryOfItsMoment) {
  View view({cell.path(), "--replay", file});
  ChildProcess client("/usr/bin/env", {"node", kScripts + "/jump.mjs", view.socket(), "1.1024",
                                       "0.3021", "0.9023", "0.5022"});
  EXPECT_EQ(client.wait(), 0) << client.output();
  const std::vector<json> said = lines_of(client);
  ASSERT_EQ(said.size(), 4u) << client.output();
  for (const json& each : said) {
    SCOPED_TRACE(each["time"].dump());
    const Before truth = before(file, each["time"]);
    EXPECT_EQ(each["cycle"], truth.cycle);
    EXPECT_EQ(each["zone"]["active"], truth.zone_active);
    const json& history = each["history"];
    ASSERT_GT(history["s"].size(), 20u);
    EXPECT_LE(history["s"].back(), each["time"].get<double>() + 0.02);
    EXPECT_EQ(least_in(history["distance"]), truth.least);
    EXPECT_NEAR(least_in(history["pairs"]["2"]), truth.least_of_pair, 1e-6);
  }
}

TEST_F(ViewOfARecording, WritesPicturesOfTheTimesThatAreAskedFor) {
  const std::string first = pictures() + "/asked-0.png", second = pictures() + "/asked-1.png";
  ChildProcess view(kView, {cell.path(), "--replay", file, "--force", "--screenshot", first, "--at",
                            "0.5", "--screenshot", second, "--at", "1", "--width", "1024"});
  EXPECT_EQ(view.wait(), 0) << view.output();
  for (const std::string& picture : {first, second}) {
    EXPECT_GT(std::filesystem::file_size(picture), 20'000u);
  }
}

TEST(View, SpeaksFoxglovesProtocolToItsOwnClient) {
  const test::CellFile cell(test::small_cell("small"));
  const DdsOptions own = test::own_dds();
  const auto dds = test::dds_arguments(own);
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, dds));
  ChildProcess robot(test::kRobot, test::with({cell.path(), "--rate", "200"}, dds));
  wait_for_poses(own, cell.cell());
  View view(test::with({cell.path()}, dds));
  ChildProcess client("/usr/bin/env", {"node", kScripts + "/foxglove.mjs", view.socket(), "reports",
                                       "30", "clearance/catalogue", "clearance/zones", "/tf",
                                       "/clearance/bodies", "/clearance/closest"});
  EXPECT_EQ(client.wait(), 0) << client.output();
  ASSERT_EQ(lines_of(client).size(), 1u) << client.output();
  const json found = lines_of(client).front();

  EXPECT_EQ(found["name"], "small");
  EXPECT_EQ(found["channels"]["clearance/distances"],
            json({{"encoding", "cdr"},
                  {"schemaName", "clearance::msg::Distances"},
                  {"schemaEncoding", "omgidl"}}));
  EXPECT_EQ(found["channels"]["/tf"]["schemaName"], "tf2_msgs/msg/TFMessage");
  // The cycles are in order and occur once, but not all of them: a frame shows the newest.
  const std::vector<std::uint64_t> cycles = found["cycles"];
  EXPECT_EQ(std::ranges::adjacent_find(cycles, std::greater_equal<>()), cycles.end());
  EXPECT_GT(cycles.back() - cycles.front(), cycles.size() - 1);
  const json& report = found["first"]["clearance/distances"];
  EXPECT_EQ(report["pairs"].size(), 3u);
  EXPECT_EQ(found["first"]["clearance/catalogue"]["scene"], "small");
  EXPECT_EQ(found["first"]["clearance/zones"]["name"], "near");
  const json& bodies = found["first"]["/clearance/bodies"];
  ASSERT_EQ(bodies.size(), 3u);
  EXPECT_EQ(bodies[0]["frame"], "left");
  EXPECT_EQ(bodies[0]["type"], 11);
  EXPECT_EQ(bodies[0]["points"], 36);  // a box has twelve triangles
  EXPECT_EQ(found["last"]["/tf"]["transforms"].size(), 3u);
  EXPECT_EQ(found["last"]["/clearance/closest"][0]["type"], 5);
  EXPECT_EQ(view.end(), 0);
}

// An arm on a cart that follows a frame, and a box that follows another.
TEST(View, DrawsLiveWhatFollowsFrames) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  test::write_text(folder / "cell.yaml",
                   "name: frames\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
                   "defaults: {age_limit_ms: 10000}\nros2: {world_frame: map}\n"
                   "robots: [{name: arm, urdf: scara.urdf, base: {frame: mir}}]\n"
                   "objects: [{name: box, frame: box_link, sphere: {radius: 0.1}}]\n"
                   "pairs: [{between: [arm, box]}]\n");
  const std::string cell = (folder / "cell.yaml").string();
  const DdsOptions own = test::own_dds();
  const auto dds = test::dds_arguments(own);
  Participant robot(own);
  test::RosFrames frames(robot), fixed(robot, test::RosFrames::Kind::kStatic);
  test::RosJoints joints(robot);
  fixed.send({{"mir", "box_link", {0.5, 0, 0}}});
  ChildProcess daemon(test::kDaemon, test::with({cell}, dds));
  View view(test::with({cell}, dds));
  ChildProcess client("/usr/bin/env",
                      {"node", kScripts + "/foxglove.mjs", view.socket(), "reports", "120", "/tf"});
  ASSERT_TRUE(eventually([&] {
    frames.send({{"map", "mir", {1, 0, 0}}});
    joints.send({"shoulder", "elbow", "push"}, {0, 0, 0.1});
    return client.wrote("\"cycles\"");
  })) << client.output();
  EXPECT_EQ(client.wait(), 0) << client.output();
  std::map<std::string, double> drawn;  // x coordinate of each drawn object, by name
  const json found = lines_of(client).front();
  for (const json& each : found["last"]["/tf"]["transforms"]) {
    drawn[each["child_frame_id"]] = each["transform"]["translation"]["x"];
  }
  ASSERT_TRUE(drawn.contains("box") && drawn.contains("foot") && drawn.contains("finger"))
      << client.output();
  EXPECT_NEAR(drawn["box"], 1.5, 1e-12);
  EXPECT_NEAR(drawn["foot"], 1.0, 1e-12);
  EXPECT_NEAR(drawn["finger"], 1.0 + 2.1, 1e-12);
  EXPECT_EQ(view.end(), 0);
}

TEST(View, ShowsToWhoeverLooksAgainLaterWhatIsAndNotWhatWas) {
  const test::CellFile cell(test::small_cell("small"));
  const DdsOptions own = test::own_dds();
  const auto dds = test::dds_arguments(own);
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, dds));
  ChildProcess robot(test::kRobot, test::with({cell.path(), "--rate", "200"}, dds));
  wait_for_poses(own, cell.cell());
  View view(test::with({cell.path()}, dds));
  std::uint64_t last = 0;
  for (int look = 0; look < 2; ++look) {
    SCOPED_TRACE(look);
    ChildProcess client("/usr/bin/env",
                        {"node", kScripts + "/foxglove.mjs", view.socket(), "reports", "5", "/tf"});
    EXPECT_EQ(client.wait(), 0) << client.output();
    ASSERT_EQ(lines_of(client).size(), 1u) << client.output();
    const std::vector<std::uint64_t> cycles = lines_of(client).front()["cycles"];
    EXPECT_GT(cycles.front(), last);
    last = cycles.back();
    // This time is longer than readers of reports are kept without a viewer.
    if (look == 0) std::this_thread::sleep_for(std::chrono::seconds(7));
  }
}

TEST(View, RecordingsHoldTheSceneForThreeDimensionalViewers) {
  const test::CellFile cell(test::small_cell("small"));
  const test::ScratchFolder folder;
  const std::string file = (folder / "scene.mcap").string();
  const auto dds = test::dds_arguments(test::own_dds());
  ChildProcess record(test::kRecord, test::with({"-o", file, "--cell", cell.path(), "--scene",
                                                 "--uncompressed", "--seconds", "3"},
                                                dds));
  ChildProcess daemon(test::kDaemon, test::with({cell.path()}, dds));
  ChildProcess robot(test::kRobot, test::with({cell.path(), "--rate", "200"}, dds));
  EXPECT_EQ(record.wait(), 0) << record.output();
  ChildProcess reader("/usr/bin/env", {"node", kScripts + "/scene.mjs", file});
  EXPECT_EQ(reader.wait(), 0) << reader.output();
  ASSERT_EQ(lines_of(reader).size(), 1u) << reader.output();
  const json found = lines_of(reader).front();
  EXPECT_EQ(found["/clearance/bodies"]["messages"], 1);
  EXPECT_EQ(found["/clearance/bodies"]["last"].size(), 3u);
  EXPECT_EQ(found["/tf"]["last"]["transforms"][0]["child_frame_id"], "left");
  EXPECT_GT(found["/tf"]["messages"], 20);
  EXPECT_LT(found["/tf"]["messages"], 190);
  EXPECT_EQ(found["/clearance/closest"]["messages"], found["/tf"]["messages"]);
}

}  // namespace
}  // namespace clearance
