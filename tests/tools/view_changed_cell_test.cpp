// clearance-view's page follows a daemon that changes its cell, live and in a recording of it.
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

bool has(const json& facts, const std::string& object) {
  const auto objects = facts.at("objects").get<std::vector<std::string>>();
  return std::ranges::find(objects, object) != objects.end();
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
  ChildProcess page("/usr/bin/env", {"node", kScripts + "/changed_cell.mjs", view.page(), "wall"});
  ASSERT_TRUE(eventually([&] { return page.wrote("ready"); })) << page.output();
  std::string changed = text;
  const std::string floor = "  - {name: floor,";
  changed.insert(changed.find(floor),
                 "  - {name: wall, groups: [still], fixed: true, pose: {xyz: [0, 5, 0]}, box: "
                 "{size: [9, 1, 9]}}\n");
  std::ofstream(cell.path()) << changed;
  daemon.signal(SIGHUP);
  EXPECT_EQ(page.wait(std::chrono::seconds(100)), 0) << page.output();
  const std::vector<json> live = lines_of(page);
  ASSERT_EQ(live.size(), 2u) << page.output();
  EXPECT_FALSE(has(live[0], "wall"));
  EXPECT_TRUE(has(live[1], "wall"));
  EXPECT_EQ(live[1].at("revision"), std::to_string(cell.cell().scene.revision));
  EXPECT_EQ(live[1].at("of_this_cell"), true);
  EXPECT_EQ(live[1].at("unnamed"), 0);
  EXPECT_EQ(live[1].at("errors"), json::array());
  daemon.signal(SIGTERM);
  EXPECT_EQ(daemon.wait(), 0) << daemon.output();

  std::ofstream(cell.path()) << text;
  const View replay({cell.path(), "--replay", file});
  ChildProcess film("/usr/bin/env", {"node", kScripts + "/changed_cell.mjs", replay.page(), "wall",
                                     "0.1", "9999", "0.2"});
  EXPECT_EQ(film.wait(std::chrono::seconds(100)), 0) << film.output();
  const std::vector<json> shown = lines_of(film);
  ASSERT_EQ(shown.size(), 3u) << film.output();
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_EQ(has(shown[i], "wall"), i == 1) << film.output();
    EXPECT_EQ(shown[i].at("of_this_cell"), true);
    EXPECT_EQ(shown[i].at("errors"), json::array());
  }
  EXPECT_TRUE(std::ranges::any_of(shown[0].at("moments"), [](const json& moment) {
    return moment.at("kind") == "cell";
  })) << "a mark on the time line";
}

}  // namespace
}  // namespace clearance::test
