// What clearance-view's page makes of its window, its keys and its scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>
#include <utility>

#include "monitor/interface/zone_cause.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Two boxes of which one swings far, before and behind a wall; eight zones with long names.
std::string swinging_cell() {
  std::string text = R"(name: swinging
units: {length: m, angle: deg}
rate_hz: 100
defaults: {age_limit_ms: 20000}
objects:
  - {name: swinging, groups: [arm], box: {size: [0.2, 0.2, 0.2]}}
  - {name: standing, groups: [arm], box: {size: [0.2, 0.3, 0.2]}}
  - {name: wall, groups: [still], fixed: true, pose: {xyz: [0.6, -1.2, 0.2]}, box: {size: [9, 0.1, 3]}}
  - {name: back, groups: [still], fixed: true, pose: {xyz: [0, 2, 0]}, box: {size: [3, 0.1, 1]}}
pairs: [{between: [arm, still], publish: true}, {between: [swinging, standing], publish: true}]
zones:
)";
  for (int i = 0; i < 8; ++i) {
    text += "  - {name: zone_of_a_long_name_" + std::to_string(i) +
            ", between: [arm, arm], enter_below: " + (i < 4 ? "9" : "0.01") +
            ", leave_above: 9.5}\n";
  }
  return text + R"(simulation:
  movers:
    - {object: swinging, centre: {xyz: [2, 0, 0]}, amplitude: [1.5, 0, 1], frequency_hz: 0.2}
    - {object: standing, centre: {xyz: [0, 0, 0]}}
)";
}

// A floor that is far larger than the rest, and two bodies with long names that overlap outside of
// zones.
constexpr const char* kCrowdedCell = R"(name: crowded
units: {length: m, angle: deg}
rate_hz: 100
defaults: {age_limit_ms: 20000}
objects:
  - {name: floor, fixed: true, pose: {xyz: [0, 0, -0.05]}, box: {size: [60, 60, 0.1]}}
  - {name: gripper_of_the_second_robot_beside_the_conveyor_left_jaw, groups: [left], box: {size: [0.2, 0.2, 0.2]}}
  - {name: gripper_of_the_second_robot_beside_the_conveyor_right_jaw, groups: [right], box: {size: [0.2, 0.2, 0.2]}}
pairs: [{between: [left, right], publish: true}, {between: [floor, left]}]
simulation:
  movers:
    - {object: gripper_of_the_second_robot_beside_the_conveyor_left_jaw, centre: {xyz: [0, 0, 0.5]}}
    - {object: gripper_of_the_second_robot_beside_the_conveyor_right_jaw, centre: {xyz: [0.15, 0, 0.5]}}
)";

// The page of a running cell.
class ViewPage : public testing::Test {
 protected:
  explicit ViewPage(std::string text = swinging_cell()) : text_(std::move(text)) {}

  // Runs these steps of view_page.mjs; returns what each found.
  std::map<std::string, json> run(const std::vector<std::string>& steps) {
    static std::map<std::string, Running> all;  // one for the pages of all tests of a cell
    const Running& running = all.try_emplace(text_, text_).first->second;
    PageScript page("view_page", with({running.view.page()}, steps));
    EXPECT_EQ(page.wait(std::chrono::seconds(280)), 0) << page.output();
    std::map<std::string, json> found;
    for (const json& line : lines_of(page)) {
      if (line.contains("step")) found[line["step"]] = line["found"];
    }
    EXPECT_EQ(found["errors"], json::array()) << page.output();
    return found;
  }

 private:
  struct Running {
    explicit Running(const std::string& text) : cell(text) {}
    const CellFile cell;
    const std::vector<std::string> dds = dds_arguments(own_dds());
    const ChildProcess daemon{kDaemon, with({cell.path()}, dds)};
    const ChildProcess robot{kRobot, with({cell.path(), "--rate", "50"}, dds)};
    const View view{with({cell.path()}, dds)};
  };
  std::string text_;
};

class SmallViewPage : public ViewPage {
 protected:
  SmallViewPage() : ViewPage(small_cell("small")) {}
};

TEST_F(ViewPage, IsNeverBlankWhileItChangesItsResolution) {
  const json seen = run({"resolution"})["resolution"];
  EXPECT_GE(seen.value("sizes", 0), 3);
  EXPECT_EQ(seen.value("blank", -1), 0);
}

TEST_F(ViewPage, MovingBodiesStayInTheFirstViewUntilAPersonMovesIt) {
  const json found = run({"firstView"})["firstView"];
  EXPECT_LE(found.value("largest", 9.0), 1.0);
  EXPECT_TRUE(found.value("stays", false));
}

TEST_F(ViewPage, AKeyAndTwoClicksLookAtAPair) {
  const json found = run({"look"})["look"];
  for (const char* const by : {"key", "clicks"}) {
    SCOPED_TRACE(by);
    EXPECT_NEAR(found[by].value("x", 9.0), 0.0, 0.3);
    EXPECT_NEAR(found[by].value("y", 9.0), 0.0, 0.3);
    EXPECT_GT(found[by].value("length", 0.0), 0.3);
  }
  EXPECT_LT(found["far"].value("length", 9.0), found["key"].value("length", 0.0));
}

TEST_F(SmallViewPage, LabelsStandAsideOfWhatTheyNameWithLinesThatLeadThere) {
  const json found = run({"labels"})["labels"];
  EXPECT_GE(found.value("labels", 0), 1);
  EXPECT_EQ(found.value("leaders", 0), found.value("labels", -1));
  EXPECT_EQ(found.value("covers", -1), 0);
  EXPECT_EQ(found.value("meet", -1), 0);
}

TEST_F(ViewPage, WhatHidesMovingBodiesFadesAsAWhole) {
  const json found = run({"fading"})["fading"];
  EXPECT_EQ(found["faded"], json({"wall"}));
  EXPECT_TRUE(found.value("veil", false));
}

TEST_F(ViewPage, TheHeaderFitsOneRowAndTheRightColumnALowWindow) {
  const json found = run({"layout"})["layout"];
  ASSERT_EQ(found["rows"].size(), 4u);
  for (const json& row : found["rows"]) {
    SCOPED_TRACE(row.dump());
    EXPECT_LE(row["height"], 64);
    EXPECT_LE(row["overflow"], 0);
    EXPECT_EQ(row["overlaps"], 0);
    EXPECT_GE(row["last"], 0);
  }
  EXPECT_LE(found["column"]["overflow"], 0);
  EXPECT_GE(found["column"]["rows"], 4);
}

class CrowdedViewPage : public ViewPage {
 protected:
  CrowdedViewPage() : ViewPage(kCrowdedCell) {}
};

TEST_F(CrowdedViewPage, TellsAPenetrationOutsideOfZonesFitsWithoutTheFloorAndLinksWhatItShows) {
  const json found = run({"crowded"})["crowded"];
  EXPECT_NEAR(found.value("distance", 0.0), -0.05, 1e-6);
  EXPECT_EQ(found.value("level", ""), "inside");
  EXPECT_THAT(found.value("header", ""), HasSubstr("alarm"));
  EXPECT_EQ(found.value("lines", 0), 1);
  EXPECT_NEAR(found.value("whole", 0.0), 60.0, 1e-3);
  EXPECT_NEAR(found.value("fit", 0.0), 0.35, 1e-3);
  EXPECT_LT(found.value("away", 100.0), 3.0);
  EXPECT_EQ(found["heads"], json({json::array(), json::array(), json::array()}))
      << "heads that run into the next column";
  ASSERT_FALSE(found["labels"].empty());
  for (const json& width : found["labels"]) EXPECT_LE(width, 310);
  EXPECT_EQ(found["link"].value("chosen", 0), 1) << found["link"].dump();
  EXPECT_TRUE(found["link"].value("same", false)) << found["link"].dump();
}

TEST_F(ViewPage, EscapeClosesTheKeys) {
  const json found = run({"keys"})["keys"];
  EXPECT_TRUE(found.value("opened", false));
  EXPECT_TRUE(found.value("closed", false));
}

TEST_F(ViewPage, NegativeDistancesHaveTicks) {
  const json found = run({"ticks"})["ticks"];
  EXPECT_EQ(found["mixed"], json({-50, 0, 500}));
  EXPECT_EQ(found["negative"], json({-50, -25, 0}));
  EXPECT_EQ(found["positive"], json({0, 250, 500}));
}

TEST_F(ViewPage, ZonesTellTheirStateAndWhyTheyAreActive) {
  const json found = run({"zones"})["zones"];
  ASSERT_FALSE(found.empty());
  const std::string first = found[0].value("text", "");
  EXPECT_THAT(first, HasSubstr("zone_of_a_long_name_"));
  EXPECT_THAT(first, HasSubstr("ACTIVE"));
  EXPECT_THAT(first, HasSubstr("why: "));
  EXPECT_THAT(found[0].value("kind", ""), HasSubstr("alarm"));
}

TEST_F(ViewPage, HiddenObjectsAreNotDrawnAndKeepTheirPairs) {
  const json found = run({"hiding"})["hiding"];
  EXPECT_EQ(found["hidden"]["off"], json({"wall", "back"}));
  EXPECT_EQ(found["hidden"]["address"], "group:still");
  EXPECT_EQ(found["hidden"]["drawn"], json({"swinging", "standing"}));
  EXPECT_EQ(found["hidden"]["notice"], "2 objects not drawn");
  EXPECT_EQ(found["hidden"]["pairs"], found["before"]["pairs"]);
  EXPECT_EQ(found["after"], found["before"]);
}

// The gap between the two fixed boxes, which no rule pairs, is 3.1 m.
TEST_F(ViewPage, MeasuresAnyTwoBodiesSavesTheTableAndPlotsMinutes) {
  std::map<std::string, json> found = run({"measuring", "csv", "minutes"});
  const json free = found["measuring"]["free"], watched = found["measuring"]["watched"];
  EXPECT_NEAR(free.value("distance", 0.0), 3.1, 1e-9);
  EXPECT_LE(free.value("lower", 9.0), 3.1 + 1e-12);
  EXPECT_GE(free.value("upper", 0.0), 3.1 - 1e-12);
  EXPECT_EQ(free["lines"], 1);
  EXPECT_THAT(free.value("hint", ""), HasSubstr("not a published pair"));
  EXPECT_THAT(watched.value("hint", ""), HasSubstr("a watched pair"));
  EXPECT_TRUE(watched.value("measured", json()).is_null());

  const json lines = found["csv"]["lines"];
  EXPECT_THAT(found["csv"].value("name", ""), testing::MatchesRegex("swinging-[0-9]+\\.csv"));
  ASSERT_EQ(lines.size(), found["csv"].value("pairs", std::size_t{0}) + 1);
  EXPECT_EQ(lines[0][2], "object_a");
  EXPECT_EQ(lines[0][5], "distance_m");
  for (std::size_t i = 1; i < lines.size(); ++i) {
    ASSERT_EQ(lines[i].size(), lines[0].size());
    const auto number = [&](std::size_t column) {
      return std::stod(std::string(lines[i][column]));
    };
    EXPECT_LE(number(6), number(5));
    EXPECT_LE(number(5), number(7));
  }
  EXPECT_EQ(found["minutes"]["width"], -600);
}

void expect_causes(const json& found, PlacedBy placed_by) {
  ASSERT_EQ(found["texts"].size(), 8u);
  for (std::uint8_t i = 0; i < 8; ++i) {
    EXPECT_EQ(found["texts"][i], cause_text(static_cast<ZoneCause>(i), found["object"], placed_by));
  }
  EXPECT_NE(found["texts"][static_cast<std::size_t>(ZoneCause::kContradicted)], "");
}

TEST_F(SmallViewPage, SaysTheCausesOfZonesInTheWordsOfAllPrograms) {
  expect_causes(run({"causes"})["causes"], PlacedBy::kPoses);
}

// Without joint states, as a person meets it who has started no driver yet.
TEST(ViewOfAUrdf, NeedsNoCellFileAndSpeaksOfJointStates) {
  const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  const std::vector<std::string> robot = {"--urdf", (folder / "scara.urdf").string()};
  const auto dds = dds_arguments(own_dds());
  const ChildProcess daemon(kDaemon, with(robot, dds));
  const View view(with(robot, dds));
  PageScript page("view_page", {view.page(), "inputs", "causes"});
  EXPECT_EQ(page.wait(std::chrono::seconds(280)), 0) << page.output();
  const std::vector<json> said = lines_of(page);
  ASSERT_FALSE(said.empty()) << page.output();
  const std::string text = said.front().value("found", json::object()).value("minimum", "");
  EXPECT_THAT(text, HasSubstr("joint states"));
  EXPECT_THAT(text, Not(HasSubstr("pose")));
  ASSERT_GE(said.size(), 2u);
  expect_causes(said[1]["found"], PlacedBy::kJointStates);
}

// A visual mesh, a visual box in a material of the file, and a shape that cannot be read.
TEST(ViewOfAUrdf, ShowsVisualMeshesWhereTheUrdfHasThem) {
  const ScratchFolder folder;
  std::string urdf = kScaraUrdf;
  const auto add = [&](const std::string& link, const std::string& geometry) {
    const std::string begin = "<link name=\"" + link + "\">";
    urdf.insert(urdf.find(begin) + begin.size(),
                "<visual><geometry>" + geometry + "</geometry><material name=\"red\"/></visual>");
  };
  add("foot", R"(<mesh filename="tip.obj" scale="0.001 0.001 0.001"/>)");
  add("upper", R"(<box size="0.8 0.1 0.1"/>)");
  add("lower", R"(<mesh filename="gone.obj"/>)");
  urdf.insert(urdf.find("</robot>"),
              R"(<material name="red"><color rgba="0.8 0.1 0.1 1"/></material>)");
  write_text(folder / "scara.urdf", urdf);
  write_text(folder / "tip.obj",
             "v 0 0 0\nv 200 0 0\nv 0 200 0\nv 0 0 200\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n");
  const std::vector<std::string> robot = {"--urdf", (folder / "scara.urdf").string()};
  const auto dds = dds_arguments(own_dds());
  const ChildProcess daemon(kDaemon, with(robot, dds));
  const ChildProcess joints(kRobot, with(with(robot, {"--rate", "50"}), dds));
  const View view(with(robot, dds));
  PageScript page("view_page", {view.page(), "visuals"});
  EXPECT_EQ(page.wait(std::chrono::seconds(280)), 0) << page.output();
  const std::vector<json> said = lines_of(page);
  ASSERT_FALSE(said.empty()) << page.output();
  const json found = said.front().value("found", json::object());
  EXPECT_EQ(found["links"], json({"foot", "upper"})) << page.output();
  EXPECT_EQ(found["replaced"], json({"foot", "upper"}));
  EXPECT_EQ(found["triangles"], json({4, 12}));
  EXPECT_EQ(found["colours"], json({"#cc1a1a", "#cc1a1a"}));
  ASSERT_EQ(found["leftOut"].size(), 1u);
  EXPECT_THAT(found["leftOut"][0], HasSubstr("gone.obj"));
  const auto mode = [](const char* text, bool visible, int replaced, bool glass) {
    return json{{"text", text}, {"visible", visible}, {"replaced", replaced}, {"glass", glass}};
  };
  EXPECT_EQ(found["modes"], json({mode("Looks", true, 2, false), mode("Both", true, 2, true),
                                  mode("Bodies", false, 0, false)}));
  // A link draws them at once. Bodies have the colour of the first look of their link.
  PageScript linked("view_page", {view.page() + "?robots=both", "robots"});
  EXPECT_EQ(linked.wait(std::chrono::seconds(280)), 0) << linked.output();
  const std::vector<json> of_link = lines_of(linked);
  ASSERT_FALSE(of_link.empty()) << linked.output();
  const json drawn = of_link.front().value("found", json::object());
  EXPECT_EQ(drawn["mode"], "both") << linked.output();
  EXPECT_EQ(drawn["text"], "Both");
  EXPECT_EQ(drawn["address"], "both");
  EXPECT_EQ(drawn["looks"], 2);
  EXPECT_EQ(drawn["colours"]["foot"], "rgb(159,20,20)");
}

}  // namespace
}  // namespace clearance::test
