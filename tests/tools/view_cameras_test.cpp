// What clearance-view's page shows of cameras, live and of a recording.
//
// Oracle: the simulated cell, whose floor, person and robot are known.
#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;

// The shipped cell with a camera, whose simulation renders a person whom the cell does not know.
class ViewOfACamera : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> daemon_arguments(
      const std::vector<std::string>& more = {}) const {
    return with(with({cell}, more), dds);
  }
  [[nodiscard]] ChildProcess robot() const {
    return {kRobot, with({cell, "--swing", "0.3", "--person", "1.5,-0.2:1.45,-0.1",
                          "--person-speed", "0.05", "--camera-rate", "10"},
                         dds)};
  }
  // Returns what a page shows of the sensors.
  static json seen_at(const std::string& address, const std::string& step = "seen") {
    PageScript page("view_page", {address, step});
    EXPECT_EQ(page.wait(std::chrono::seconds(280)), 0) << page.output();
    std::map<std::string, json> found;
    for (const json& line : lines_of(page)) {
      if (line.contains("step")) found[line["step"]] = line["found"];
    }
    EXPECT_EQ(found["errors"], json::array()) << page.output();
    return found[step];
  }
  // Points on the floor, on the shelf, and on the person, within the stated error.
  static void expect_floor_and_person(const json& seen) {
    ASSERT_TRUE(seen.is_object());
    EXPECT_EQ(seen["bodies"], 0) << "the ball of the camera's view is drawn";
    const std::vector<double> places = seen["places"];
    ASSERT_GT(places.size(), 3u * 1000);
    std::size_t floor = 0, person = 0, below = 0;
    for (std::size_t i = 0; i + 2 < places.size(); i += 3) {
      const Vec3 at(places[i], places[i + 1], places[i + 2]);
      floor += std::abs(at.z()) < 0.07;
      below += at.z() < -0.1;
      person += at.z() > 0.9 && (at - Vec3(1.5, -0.2, at.z())).norm() < 0.5;
    }
    EXPECT_GT(floor, 100u);
    EXPECT_GT(person, 20u);
    EXPECT_EQ(below, 0u);
    EXPECT_GT(seen.value("drawn", 0), 500);
    EXPECT_GT(seen["shells"].value("hand", 0.0), 0.001);
    EXPECT_LT(seen["shells"].value("hand", 9.0), 2.0);
    EXPECT_NEAR(seen["pose"][2], 1.9, 1e-9);
    EXPECT_EQ(seen["row"][0], "camera");
  }

  std::string cell = places::sources() + "/config/cells/camera.yaml";
  DdsOptions own = own_dds();
  std::vector<std::string> dds = dds_arguments(own);
};

// The nearest element to a link is on the person, or on what stands around.
TEST_F(ViewOfACamera, DrawsItsPointsTheBlindShellsAndTheNearestElement) {
  const ChildProcess daemon(kDaemon, daemon_arguments());
  const ChildProcess simulated = robot();
  const View view(with({cell}, dds));
  const json seen = seen_at(view.page());
  expect_floor_and_person(seen);
  // The line and the bodies of a chosen pair have the colour of its points, too.
  EXPECT_LT(2 * seen.value("without", 9999), seen.value("drawn", 0));
  EXPECT_GE(seen.value("lines", 0), 1) << "the pair with the nearest element has a line";
  EXPECT_EQ(seen["modes"], json::parse(R"([{"all": true, "shells": false},
      {"all": false, "shells": false}, {"all": true, "shells": true}])"));
}

TEST_F(ViewOfACamera, DrawsTheSameOfARecording) {
  const ScratchFolder folder;
  const std::string file = (folder / "run.mcap").string();
  {
    ChildProcess daemon(kDaemon, daemon_arguments({"--record", file}));
    const ChildProcess simulated = robot();
    wait_for_poses(own, std::get<Cell>(read_cell(cell)), 2.2);
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  }
  const View view({cell, "--replay", file});
  expect_floor_and_person(seen_at(view.page() + "?t=2"));
}

// The simulated robot is where its joints say, so the medians are within the camera's noise.
TEST_F(ViewOfACamera, PlotsHowFarLinksAreSeenFromTheirPlaces) {
  const ScratchFolder folder;
  std::string text = read_text(cell);
  const std::string sensor = "  - name: camera\n";
  text.insert(text.find(sensor) + sensor.size(), "    witness: true\n");
  const std::string robots = places::sources() + "/config/cells/seven_joint_arm/";
  for (const char* const file : {"urdf", "srdf"}) {
    const std::string named = std::string(file) + ": seven_joint_arm/";
    text.replace(text.find(named), named.size(), std::string(file) + ": " + robots);
  }
  cell = (folder / "witness.yaml").string();
  write_text(cell, text);
  const auto expect_plot = [](const json& found) {
    ASSERT_TRUE(found.is_object());
    for (const std::string name : found["names"]) EXPECT_EQ(name.find("camera: "), 0u) << name;
    for (const double each : found["known"]) EXPECT_LT(std::abs(each), 20.0);
    EXPECT_LE(found["names"].size(), 6u);
  };
  const std::string file = (folder / "run.mcap").string();
  {
    ChildProcess daemon(kDaemon, daemon_arguments({"--record", file}));
    const ChildProcess simulated = robot();
    const View view(with({cell}, dds));
    expect_plot(seen_at(view.page(), "residuals"));
    daemon.signal(SIGTERM);
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
  }
  const View view({cell, "--replay", file});
  expect_plot(seen_at(view.page() + "?t=60", "residuals"));
}

}  // namespace
}  // namespace clearance::test
