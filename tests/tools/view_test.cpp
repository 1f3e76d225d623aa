// clearance-view as people and programs use it: in a browser, and through Foxglove's own client.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/places.hpp"
#include "tests/shared/ros_frames.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/person_and_robot.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;

const std::string kTwoArms = test::places::sources() + "/config/cells/two_arms.yaml";

TEST(View, ShowsInABrowserWhatTheTopicSaysAndThatTheDaemonHasEnded) {
  const DdsOptions dds = own_dds();
  const auto arguments = dds_arguments(dds);
  const Cell cell = std::get<Cell>(read_cell(kTwoArms));
  Participant client(dds);
  ChildProcess daemon(kDaemon, with({kTwoArms}, arguments));
  ChildProcess robot(kRobot, with({kTwoArms, "--rate", "250"}, arguments));
  View view(with({kTwoArms}, arguments));
  Distances reports(client, cell);
  PageScript page("page", {view.page(), pictures(), "live"});
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
  const CellFile cell(kPersonAndRobot);
  const auto dds = dds_arguments(own_dds());
  ChildProcess daemon(kDaemon, with({cell.path()}, dds));
  ChildProcess robot(kRobot, with({cell.path(), "--rate", "200"}, dds));
  View view(with({cell.path()}, dds));
  std::filesystem::remove(pictures() + "/separation.png");
  PageScript page("page", {view.page(), pictures(), "separation"});
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(pictures() + "/separation.png"); },
                         std::chrono::seconds(100)))
      << page.output();
  robot.signal(SIGTERM);
  EXPECT_EQ(page.wait(std::chrono::seconds(200)), 0) << page.output();
  ASSERT_EQ(lines_of(page).size(), 1u) << page.output();
  const json shown = lines_of(page).front();
  EXPECT_EQ(shown["errors"], json::array());
  const std::vector<std::string> measured = shown["measured"], lost = shown["lost"];
  ASSERT_EQ(measured.size(), 8u);
  EXPECT_EQ(measured[0], "people: person – robot");
  EXPECT_EQ(measured[1], "1700");  // mm
  // C, and the distance at 1.6 m/s during the robot's reaction and the age of the pose, up to the
  // age limit.
  const double protective = std::stod(measured[2]);
  EXPECT_GE(protective, 260.0);
  EXPECT_LE(protective, 260.0 + 1.6 * 300.0);
  EXPECT_NEAR(std::stod(measured[3]), 1700.0 - protective, 1.0);
  EXPECT_EQ(measured[4], "1.00");
  EXPECT_EQ(measured[6], "-") << "figures of stops are those of robots that state them";
  EXPECT_THAT(lost, testing::ElementsAre(measured[0], "?", "?", "?", "0.00", "0.00", "-", "-"));
}

TEST(View, SpeaksFoxglovesProtocolToItsOwnClient) {
  RunningSmallCell running;
  View view(running.arguments());
  Script client("foxglove", {view.socket(), "reports", "30", "clearance/catalogue",
                             "clearance/zones", "/tf", "/clearance/bodies", "/clearance/closest"});
  EXPECT_EQ(client.wait(), 0) << client.output();
  ASSERT_EQ(lines_of(client).size(), 1u) << client.output();
  const json found = lines_of(client).front();

  EXPECT_EQ(found["name"], "small");
  EXPECT_EQ(found["channels"]["clearance/distances"],
            json({{"encoding", "cdr"},
                  {"schemaName", "clearance::msg::Distances"},
                  {"schemaEncoding", "omgidl"}}));
  EXPECT_EQ(found["channels"]["/tf"]["schemaName"], "tf2_msgs/msg/TFMessage");
  EXPECT_EQ(found["redefined"], json::array()) << "names that channels define differently";
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
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  write_text(folder / "cell.yaml",
             "name: frames\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
             "defaults: {age_limit_ms: 10000}\nros2: {world_frame: map}\n"
             "robots: [{name: arm, urdf: scara.urdf, base: {frame: mir}}]\n"
             "objects: [{name: box, frame: box_link, sphere: {radius: 0.1}}]\n"
             "pairs: [{between: [arm, box]}]\n");
  const std::string cell = (folder / "cell.yaml").string();
  const DdsOptions own = own_dds();
  const auto dds = dds_arguments(own);
  Participant robot(own);
  RosFrames frames(robot), fixed(robot, RosFrames::Kind::kStatic);
  RosJoints joints(robot);
  fixed.send({{"mir", "box_link", {0.5, 0, 0}}});
  ChildProcess daemon(kDaemon, with({cell}, dds));
  View view(with({cell}, dds));
  Script client("foxglove", {view.socket(), "reports", "120", "/tf"});
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
  RunningSmallCell running;
  View view(running.arguments());
  std::uint64_t last = 0;
  for (int look = 0; look < 2; ++look) {
    SCOPED_TRACE(look);
    Script client("foxglove", {view.socket(), "reports", "5", "/tf"});
    EXPECT_EQ(client.wait(), 0) << client.output();
    ASSERT_EQ(lines_of(client).size(), 1u) << client.output();
    const std::vector<std::uint64_t> cycles = lines_of(client).front()["cycles"];
    EXPECT_GT(cycles.front(), last);
    last = cycles.back();
    // This time is longer than readers of reports are kept without a viewer.
    if (look == 0) std::this_thread::sleep_for(std::chrono::seconds(3));
  }
}

TEST(View, RecordingsHoldTheSceneForThreeDimensionalViewers) {
  const CellFile cell(small_cell("small"));
  const ScratchFolder folder;
  const std::string file = (folder / "scene.mcap").string();
  const auto dds = dds_arguments(own_dds());
  ChildProcess record(kRecord, with({"-o", file, "--cell", cell.path(), "--scene", "--uncompressed",
                                     "--seconds", "3"},
                                    dds));
  ChildProcess daemon(kDaemon, with({cell.path()}, dds));
  ChildProcess robot(kRobot, with({cell.path(), "--rate", "200"}, dds));
  EXPECT_EQ(record.wait(), 0) << record.output();
  Script reader("scene", {file});
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
}  // namespace clearance::test
