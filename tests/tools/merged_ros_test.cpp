// A joined cell for ROS 2: clearance-merge writes what a daemon of the whole cell would write.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "monitor/client/commands.hpp"
#include "monitor/wire/moveit_types.hpp"
#include "monitor/wire/ros_messages.hpp"
#include "tests/monitor/ask/stopping_scara.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/shared/ros_reader.hpp"
#include "tests/tools/shared_cells.hpp"

namespace clearance::test {
namespace {

using std::chrono::milliseconds;
using Float64 = std_msgs_msg_dds__Float64_;
using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;
using MarkerArray = visualization_msgs_msg_dds__MarkerArray_;
using RosPlanningScene = moveit_msgs_msg_dds__PlanningScene_;

RosType type_of_kind(TopicKind kind) {
  const auto at = std::ranges::find(kRosMessageTypes, kind, &clearance::RosMessage::kind);
  return at->type;
}

class MergedForRos : public SharedCells {
 protected:
  MergedForRos() : SharedCells("commands: {from: [planner]}\n") {}
  using SharedCells::SharedCells;

  // Starts the shares and clearance-merge, and waits for the first number.
  void start_joined(const std::string& cell_of_merge = {}) {
    start_all();
    const std::string path = cell_of_merge.empty() ? file.path() : cell_of_merge;
    merge.emplace(kMerge, with({path, "--late-ms", "300", "--ros2", "all"}, dds_arguments(dds)));
    ASSERT_NE(minimum.next(), nullptr) << merge->output();
  }
  // Reads numbers until one satisfies the predicate.
  template <class IsSo>
  static bool comes(RosReader<Float64>& numbers, const IsSo& is_so) {
    return eventually([&] { return numbers.take() && is_so(numbers.last().data); });
  }
  // The levels of the statuses of a message, by name without the cell.
  static std::map<std::string, int> levels(const DiagnosticArray& message) {
    std::map<std::string, int> found;
    for (std::uint32_t i = 0; i < message.status._length; ++i) {
      const auto& status = message.status._buffer[i];
      const std::string name = status.name;
      found[name.substr(name.find(": ") + 2)] = status.level;
    }
    return found;
  }

  Participant reader{dds};
  RosReader<Float64> minimum{reader, kRosFloat64, "rt/clearance/minimum_distance"};
  RosReader<Float64> scaling{reader, kRosFloat64, "rt/clearance/speed_scaling"};
  RosReader<DiagnosticArray> diagnostics{reader, kRosDiagnostics, "rt/diagnostics"};
  std::optional<ChildProcess> merge;
};

// The boxes meet: the distance falls below the threshold of the zone, and rises again.
TEST_F(MergedForRos, NumbersAreThoseOfTheWholeCell) {
  start_joined();
  EXPECT_TRUE(comes(minimum, [](double m) { return m > 0.3; })) << merge->output();
  EXPECT_TRUE(comes(minimum, [](double m) { return m > 0.0 && m < 0.3; }));
  EXPECT_TRUE(comes(scaling, [](double part) { return part == 0.0; }));
  EXPECT_TRUE(comes(scaling, [](double part) { return part == 1.0; }));
}

TEST_F(MergedForRos, AShareThatIsNotHeardIsUnknownAndNamedAsAnError) {
  start_joined();
  // The daemons tell their health once per second.
  ASSERT_TRUE(eventually([&] {
    if (!diagnostics.take()) return false;
    const auto found = levels(diagnostics.last());
    return found.at("distances") == 0 && found.at("share boxes") == 0;
  })) << merge->output();
  EXPECT_TRUE(levels(diagnostics.last()).contains("zone near"));
  daemons["boxes"]->signal(SIGKILL);
  EXPECT_TRUE(comes(minimum, [](double m) { return m == -kInfinity; })) << merge->output();
  EXPECT_TRUE(comes(scaling, [](double part) { return part == 0.0; }));
  EXPECT_TRUE(eventually([&] {
    if (!diagnostics.take()) return false;
    const auto found = levels(diagnostics.last());
    return found.at("share boxes") == 2 && found.at("distances") == 2 &&
           found.at("zone near") == 2 && found.at("share left floor") == 0;
  })) << merge->output();
}

TEST_F(MergedForRos, MarkersAndMessagesHaveThePairsOfAllShares) {
  RosReader<MarkerArray> markers(reader, kRosMarkers, "rt/clearance/markers");
  // The ROS 2 type has the layout of our own.
  RosReader<clearance_msg_Distances> reports(reader, type_of_kind(TopicKind::kDistances),
                                             "rt/clearance/distances");
  start_joined();
  EXPECT_TRUE(eventually([&] {
    return reports.take() && reports.last().pairs._length == 3 && reports.last().minimum_certified;
  })) << merge->output();
  bool has_bodies = false, has_line = false;
  EXPECT_TRUE(eventually([&] {
    if (!markers.take()) return false;
    for (std::uint32_t i = 0; i < markers.last().markers._length; ++i) {
      const std::string space = markers.last().markers._buffer[i].ns;
      has_bodies = has_bodies || space == "bodies";
      has_line = has_line || space == "lines";
    }
    return has_bodies && has_line;
  })) << merge->output();
}

// A changed cell has a scene of its own, and its numbers follow.
TEST_F(MergedForRos, AChangedCellIsReadAgain) {
  RosReader<RosPlanningScene> scenes(reader, kRosMonitoredScene,
                                     "rt/clearance/monitored_planning_scene");
  start_joined();
  ASSERT_NE(scenes.next(), nullptr) << merge->output();
  ASSERT_TRUE(merge->tells("share-heard", {"right floor"}));
  client::Commands commands(connection, "planner");
  const auto moved =
      commands.send({SetZoneThresholds{.zone = "near", .enter_below = 0.2, .leave_above = 0.25}});
  ASSERT_TRUE(moved) << merge->output() << logs();
  ASSERT_TRUE(moved->done()) << moved->reason;
  EXPECT_NE(scenes.next(), nullptr) << "the scene of the changed cell" << merge->output();
  while (minimum.take()) {
  }
  EXPECT_TRUE(comes(minimum, [](double m) { return m > 0.0; })) << merge->output();
}

// clearance-merge has the cell file alone, and the changed cell needs a mesh that only the shares
// have.
TEST_F(MergedForRos, ACellThatCannotBeReadThereIsToldByName) {
  const ScratchFolder other;
  const std::string copy = other / "cell.yaml";
  const std::string text = shared_cell("commands: {from: [planner]}\n");
  write_text(copy, text);
  start_joined(copy);
  write_text(std::filesystem::path(file.path()).parent_path() / "wedge.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  std::string changed = text;
  const std::string box = "box: {size: [0.2, 0.3, 0.2]}";
  changed.replace(changed.find(box), box.size(), "mesh: {file: wedge.obj}");
  write_text(file.path(), changed);
  for (const auto& [name, daemon] : daemons) daemon->signal(SIGHUP);
  EXPECT_TRUE(merge->tells("cell-not-read", {"wedge"})) << merge->output() << logs();
  merge->signal(SIGTERM);
  EXPECT_EQ(merge->wait(), 0) << merge->output();
}

// The finger circles between two pins at 2 m, one of each share: at 0.9 rad and at -1.2 rad.
std::string stopping_cell(const std::string& urdf) {
  const auto pin = [](const std::string& name, double at) {
    return "  - {name: " + name + ", fixed: true, sphere: {radius: 0.1}, pose: {xyz: [" +
           std::to_string(2.0 * std::cos(at)) + ", " + std::to_string(2.0 * std::sin(at)) +
           ", 0]}}\n";
  };
  return "name: stops\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
         "defaults: {age_limit_ms: 10000}\nrobots:\n  - {name: arm, urdf: " +
         urdf +
         ", joints: {elbow: {velocity: 2}}, stopping: {reaction_ms: 40, path: kept, time_ms: "
         "300}}\nobjects:\n" +
         pin("ahead", 0.9) + pin("behind", -1.2) +
         "pairs: [{between: [arm, ahead]}, {between: [arm, behind]}]\n"
         "zones: [{name: stops, between: [arm, ahead], stops: {margin: 0.05}}]\n"
         "shares:\n  - {name: ahead, pairs: [{between: [arm, ahead]}]}\n"
         "  - {name: behind, pairs: [{between: [arm, behind]}]}\n";
}

class MergedStops : public MergedForRos {
 protected:
  MergedStops() : MergedForRos(CellText{stopping_cell(urdf())}) {}
  // The share of its speed, sent for a shoulder at `angle` that moves, is as said.
  template <class IsSo>
  bool comes_at(double angle, double speed, const IsSo& is_so) {
    return eventually([&] {
      joints.send({"shoulder", "elbow", "push"}, {angle, 0.0, 0.0}, {speed, 0.0, 0.0});
      return scaling.take() && is_so(scaling.last().data);
    });
  }

  RosJoints joints{reader};

 private:
  static std::string urdf() {
    static const ScratchFolder folder;
    write_text(folder / "scara.urdf", finger_urdf());
    return (folder / "scara.urdf").string();
  }
};

// The most that a report proves: its positions have no age.
double largest_scaling(double angle, double speed, double pin, double margin) {
  const double until_pin = std::abs(pin - angle) - angle_before(margin);
  return (until_pin - 0.045 * speed) / (0.3 * speed);
}

TEST_F(MergedStops, TheScalingIsTheLeastOfAllSharesAndZeroWithoutOneOfThem) {
  start_joined();
  ASSERT_TRUE(joints.is_heard());
  const auto is_clear = [](double part) { return part == 1.0; };
  ASSERT_TRUE(comes_at(0.0, 0.0, is_clear)) << merge->output() << logs();
  const double ahead = largest_scaling(0.5, 1.9, 0.9, 0.05);
  const double behind = largest_scaling(-0.7, 1.9, -1.2, 0.0);
  ASSERT_GT(behind, ahead + 0.1);
  EXPECT_TRUE(comes_at(0.5, 1.9, [&](double part) { return 0.0 < part && part <= ahead; }));
  EXPECT_TRUE(comes_at(0.5, -0.1, is_clear));
  EXPECT_TRUE(comes_at(-0.7, -1.9, [&](double part) { return 0.0 < part && part <= behind; }));
  EXPECT_TRUE(comes_at(0.5, -0.1, is_clear));
  daemons["behind"]->signal(SIGKILL);
  EXPECT_TRUE(comes_at(0.5, -0.1, [](double part) { return part == 0.0; })) << merge->output();
}

}  // namespace
}  // namespace clearance::test
