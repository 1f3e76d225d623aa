// clearance-view's page follows a daemon that changes its cell, live and in a recording of it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/shared/scratch_folder.hpp"
#include "tests/tools/running_cell.hpp"
#include "tests/tools/running_view.hpp"

namespace clearance::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::MatchesRegex;

bool has(const json& facts, const std::string& object) {
  const auto objects = facts.at("objects").get<std::vector<std::string>>();
  return std::ranges::find(objects, object) != objects.end();
}

// The rows of the contact that the changed cell allows, and of what it attaches.
void expect_grasp(const json& facts) {
  SCOPED_TRACE(facts.dump());
  const json contacts = facts.at("contacts"), attached = facts.at("attached");
  ASSERT_EQ(contacts.size(), 1u);
  ASSERT_EQ(contacts[0].size(), 6u);
  EXPECT_THAT(contacts[0][0], HasSubstr("grasp: "));
  EXPECT_EQ(contacts[0][1], "allowed");
  EXPECT_THAT(contacts[0][2], HasSubstr(" of 2.0"));
  EXPECT_EQ(contacts[0][3], "planner");
  EXPECT_THAT(contacts[0][4], MatchesRegex("cycle [1-9][0-9]*, .* s"));
  EXPECT_EQ(contacts[0][5], "until the distance is 5000.0 mm");
  ASSERT_EQ(attached.size(), 1u);
  EXPECT_EQ(attached[0][0], "part");
  EXPECT_EQ(attached[0][1], "left");
  EXPECT_THAT(attached[0][2], MatchesRegex("(.* s, )?cycle [1-9][0-9]*")) << "after the start";
}

TEST(ViewOfAChangedCell, ShowsTheCellInForceLiveAndAtEveryMomentOfItsRecording) {
  const std::string text = small_cell("changing");
  CellFile cell{text};
  const Cell first = cell.cell();
  const ScratchFolder folder;
  const std::string file = (folder / "run.mcap").string();
  const DdsOptions own = own_dds();
  const auto dds = dds_arguments(own);
  ChildProcess daemon(kDaemon, with({cell.path(), "--record", file}, dds));
  const ChildProcess robot(kRobot, with({cell.path(), "--rate", "200"}, dds));
  wait_for_poses(own, first);
  const View view(with({cell.path()}, dds));
  PageScript page("changed_cell", {view.page(), "wall"});
  ASSERT_TRUE(eventually([&] { return page.wrote("ready"); })) << page.output();
  std::string changed = text;
  const std::string floor = "  - {name: floor,";
  changed.insert(changed.find(floor),
                 "  - {name: wall, groups: [still], fixed: true, pose: {xyz: [0, 5, 0]}, box: "
                 "{size: [9, 1, 9]}}\n");
  changed.insert(changed.find(floor),
                 "  - {name: part, attached: {to: left, pose: {xyz: [0, 0, 0.15]}}, box: {size: "
                 "[0.1, 0.1, 0.1]}}\n");
  changed.insert(changed.find("simulation:"),
                 "contacts:\n  - {name: grasp, between: [part, right], depth: 0.002, by: planner, "
                 "reason: a test, "
                 "until: {distance: 5}}\n");
  std::ofstream(cell.path()) << changed;
  daemon.signal(SIGHUP);
  EXPECT_EQ(page.wait(std::chrono::seconds(200)), 0) << page.output();
  const std::vector<json> live = lines_of(page);
  ASSERT_EQ(live.size(), 2u) << page.output();
  EXPECT_FALSE(has(live[0], "wall"));
  EXPECT_TRUE(has(live[1], "wall"));
  EXPECT_EQ(live[1].at("revision"), std::to_string(cell.cell().scene.revision));
  EXPECT_EQ(live[1].at("of_this_cell"), true);
  EXPECT_EQ(live[1].at("unnamed"), 0);
  EXPECT_EQ(live[1].at("errors"), json::array());
  EXPECT_EQ(live[0].at("contacts"), json::array());
  EXPECT_EQ(live[0].at("attached"), json::array());
  EXPECT_EQ(live[1].at("kept"), true) << "curves of the page before it was loaded again";
  expect_grasp(live[1]);
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();

  std::ofstream(cell.path()) << text;
  const View replay({cell.path(), "--replay", file});
  PageScript film("changed_cell", {replay.page(), "wall", "0.1", "9999", "0.2"});
  EXPECT_EQ(film.wait(std::chrono::seconds(200)), 0) << film.output();
  const std::vector<json> shown = lines_of(film);
  ASSERT_EQ(shown.size(), 3u) << film.output();
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_EQ(has(shown[i], "wall"), i == 1) << film.output();
    EXPECT_EQ(shown[i].at("of_this_cell"), true);
    EXPECT_EQ(shown[i].at("errors"), json::array());
  }
  EXPECT_EQ(shown[0].at("attached"), json::array()) << "before the change";
  expect_grasp(shown[1]);
  EXPECT_GT(shown[1].at("curve"), 1) << "of a pair that the later cell brings";
  EXPECT_TRUE(std::ranges::any_of(shown[0].at("moments"),
                                  [](const json& moment) {
                                    const std::string said = moment.at("text");
                                    return moment.at("kind") == "cell" &&
                                           said.ends_with(
                                               ": part is attached to left, contact grasp "
                                               "is allowed, part is added, wall is added");
                                  }))
      << "a mark on the time line: " << shown[0].at("moments");
}

}  // namespace
}  // namespace clearance::test
