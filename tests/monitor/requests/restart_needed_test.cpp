// Some changes of the cell need a restart.
#include <gtest/gtest.h>

#include <functional>

#include "monitor/requests/restart_needed.hpp"
#include "tests/config/cells.hpp"
#include "tests/monitor/tick/scara_cell.hpp"

namespace clearance {
namespace {

Cell small() {
  return read_good(
      "name: test\nunits: {length: m, angle: rad}\n"
      "objects:\n"
      "  - {name: a, sphere: {radius: 0.1}}\n"
      "  - {name: b, sphere: {radius: 0.1}}\n"
      "pairs: [{between: [a, b]}]\n");
}

TEST(RestartNeeded, ForNoChangeOfTheScene) {
  const Cell before = small();
  Cell now = before;
  now.scene.objects[0].margin = 0.1;
  now.scene.objects.push_back(now.scene.objects[0]);
  now.scene.objects.back().name = "c";
  now.scene.zones.push_back({});
  now.scene.pairs.clear();
  now.scene.budget = 7;
  now.scene.robots.emplace_back().is_attached = true;
  EXPECT_EQ(restart_needed(before, now), std::nullopt);
}

TEST(RestartNeeded, ForAllThatReadersWritersAndTheLoopAreMadeFor) {
  const std::vector<std::pair<std::string, std::function<void(Cell&)>>> changes = {
      {"name", [](Cell& cell) { cell.scene.name = "other"; }},
      {"rate", [](Cell& cell) { cell.scene.rate_hz = 500; }},
      {"domain", [](Cell& cell) { cell.domain = 5; }},
      {"partition", [](Cell& cell) { cell.partition = "x"; }},
      {"interface", [](Cell& cell) { cell.interface = "default"; }},
      {"topics", [](Cell& cell) { cell.topics.gradients = "x"; }},
      {"ros2", [](Cell& cell) { cell.ros.outputs.*kRosOutputs[0].topic = "/x"; }},
      {"use_sim_time", [](Cell& cell) { cell.ros.use_sim_time = true; }},
      {"frame", [](Cell& cell) { cell.scene.objects[0].frame = "x"; }},
      {"first robot", [](Cell& cell) { cell.scene.robots.emplace_back(); }},
      {"commands", [](Cell& cell) { cell.commands.from = {"x"}; }},
      {"commands", [](Cell& cell) { cell.commands.folders = {"/x"}; }},
      {"topics", [](Cell& cell) { cell.topics.commands = "x"; }},
      {"capacity", [](Cell& cell) { cell.capacity.bytes = 1; }},
  };
  const Cell before = small();
  for (const auto& [what, change] : changes) {
    Cell now = before;
    change(now);
    const auto reason = restart_needed(before, now);
    ASSERT_TRUE(reason) << what;
    EXPECT_NE(reason->find(what), std::string::npos) << *reason;
  }
}

TEST(BeyondCapacity, IsASceneWithOneMoreThanWasStated) {
  Cell before = small();
  before.capacity = {.objects = 3, .parts = 5, .pairs = 2};
  const SceneCapacity capacity = capacity_for(before);
  const auto more = [](auto& list, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) list.push_back(list.front());
  };
  const std::vector<std::tuple<std::string, std::size_t, std::function<void(Cell&, std::size_t)>>>
      growths = {
          {"objects", 3, [&](Cell& cell, std::size_t by) { cell.scene.objects.resize(2 + by); }},
          {"variables", 3, [&](Cell& cell, std::size_t by) { cell.scene.variables.resize(by); }},
          {"parts", 5, [&](Cell& cell, std::size_t by) { more(cell.scene.objects[0].parts, by); }},
          {"pairs", 2, [&](Cell& cell, std::size_t by) { more(cell.scene.pairs, by); }}};
  for (const auto& [what, most, grow] : growths) {
    Cell now = before;
    grow(now, most);
    EXPECT_EQ(beyond_capacity(now, capacity), std::nullopt) << what;
    now = before;
    grow(now, most + 1);
    const auto reason = beyond_capacity(now, capacity);
    ASSERT_TRUE(reason) << what;
    EXPECT_NE(reason->find(what), std::string::npos) << *reason;
  }
}

}  // namespace
}  // namespace clearance
