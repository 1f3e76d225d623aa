// MoveIt's messages to a cell in shares: all daemons hear them, in any order. That of the first
// share does them, and the others take over its scene.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "config/cell/share_topics.hpp"
#include "monitor/client/commands.hpp"
#include "monitor/client/shared_cell.hpp"
#include "monitor/wire/moveit_types.hpp"
#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/byte_writer.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/tools/shared_cells.hpp"

namespace clearance::test {
namespace {

using client::ShareState;
using moveit::AttachedCollisionObject;
using moveit::CollisionObject;
using moveit::Operation;
using moveit::PlanningScene;
using std::chrono::milliseconds;

// Two boxes, a robot beside them, and what MoveIt adds. The first share has no pair of the robot.
std::string shares_with_moveit() {
  static const ScratchFolder folder;
  write_text(folder / "scara.urdf", kScaraUrdf);
  std::string text = meeting_cell();
  const std::string rule = "  - {between: [left, right], publish: true}\n";
  text.insert(text.find(rule),
              "  - {between: [left, moveit]}\n  - {between: [scara, moveit]}\n"
              "  - {between: [scara, floor]}\n  - {between: [scara, left]}\n");
  return text + "robots: [{name: scara, urdf: " + (folder / "scara.urdf").string() +
         ", base: {pose: {xyz: [5, 0, 2]}}}]\n"
         "ros2: {collision_object: true, attached_collision_object: true, planning_scene: true}\n"
         "capacity: {objects: 40, parts: 60, pairs: 400, bytes: 1000000}\n"
         "commands: {from: [planner]}\n"
         "shares:\n"
         "  - {name: boxes, pairs: [{between: [arm, arm]}]}\n"
         "  - {name: left floor, pairs: [{between: [left, floor]}]}\n"
         "  - {name: robot, pairs: [{between: [right, floor]}, {between: [scara, floor]}, "
         "{between: [scara, left]}, {between: [left, moveit]}, {between: [scara, moveit]}]}\n";
}

class MoveItSharedCells : public SharedCells {
 protected:
  MoveItSharedCells() : SharedCells(CellText{shares_with_moveit()}) {}
  void start_whole(const std::vector<std::string>& more = {}) {
    for (const Share& share : cell.shares.all) start(share.name, more);
    ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  }
  using Writer = std::unique_ptr<ByteWriter>;
  template <class Message>
  Writer writer_of(const RosType& type, const std::string& topic, const Message& message) {
    auto made = std::make_unique<ByteWriter>(sender, dds.partition, *type.descriptor, "rt/" + topic,
                                             moveit::cdr_of(message));
    EXPECT_TRUE(eventually([&] { return matched_readers(made->writer()) == daemons.size(); }))
        << logs();
    for (const auto& [name, daemon] : daemons)
      EXPECT_TRUE(meets_writers_of(sender, *daemon)) << name << logs();
    return made;
  }
  Writer writer_of(const CollisionObject& message) {
    return writer_of(kRosCollisionObject, "collision_object", message);
  }
  Writer writer_of(const AttachedCollisionObject& message) {
    return writer_of(kRosAttachedCollisionObject, "attached_collision_object", message);
  }
  Writer writer_of(const PlanningScene& message) {
    return writer_of(kRosPlanningScene, "planning_scene", message);
  }
  static CollisionObject sphere(const std::string& name, double x = 1.0) {
    return moveit::sphere_object(name, "world", {x, 0, 8});
  }
  static PlanningScene scene_with(const CollisionObject& object) {
    PlanningScene scene;
    scene.is_diff = scene.robot_state_is_diff = true;
    scene.collision_objects = {object};
    return scene;
  }
  [[nodiscard]] std::string text() const {
    return whole.catalogue() == nullptr ? "" : whole.catalogue()->cell_yaml;
  }
  [[nodiscard]] bool has(const std::string& name) const {
    return text().find("name: " + name) != std::string::npos;
  }
  // All shares have one scene, with these objects.
  bool are_whole_with(const std::vector<std::string>& names, int seconds = 20) {
    return read_until(
        whole,
        [&] {
          return whole.is_whole() &&
                 std::ranges::all_of(names, [&](const std::string& name) { return has(name); });
        },
        seconds);
  }
  // A killed daemon counts as a reader until its lease ends. The number of readers therefore does
  // not show whether its successor hears already. Hence the message is sent again: that changes
  // nothing.
  bool are_whole_after(ByteWriter& writer, const std::vector<std::string>& names) {
    for (int attempt = 0; attempt < 40; ++attempt) {
      writer.send();
      if (are_whole_with(names, 1)) return true;
    }
    return false;
  }
  [[nodiscard]] std::uint64_t daemon_of(const std::string& share) const {
    const auto at = std::ranges::find(whole.shares(), share, &client::ShareCheck::name);
    return at == whole.shares().end() ? 0 : at->daemon;
  }
  void kill_and_start(const std::string& share) {
    daemons[share]->signal(SIGKILL);
    daemons[share]->wait();
    start(share);
  }

  client::SharedCell whole{connection, {.late_after = milliseconds(500)}};
  Participant sender{dds};
};

// A stopped daemon gets both messages at once, and takes those of one topic first.
TEST_F(MoveItSharedCells, HaveOneSceneWhereMessagesOfTwoTopicsComeToThemInOtherOrders) {
  start_whole();
  const Writer object = writer_of(sphere("a0")), scene = writer_of(scene_with(sphere("b0", 2.0)));
  int round = 0;
  for (const char* stopped : {"left floor", "boxes"}) {
    for (const bool object_first : {true, false}) {
      SCOPED_TRACE(std::string(stopped) + (object_first ? ", object first" : ", scene first"));
      const std::string number = std::to_string(round++);
      object->set(moveit::cdr_of(sphere("a" + number, 3.0 * round)));
      scene->set(moveit::cdr_of(scene_with(sphere("b" + number, 3.0 * round + 1.0))));
      daemons[stopped]->signal(SIGSTOP);
      (object_first ? object : scene)->send();
      std::this_thread::sleep_for(milliseconds(100));
      (object_first ? scene : object)->send();
      std::this_thread::sleep_for(milliseconds(100));
      daemons[stopped]->signal(SIGCONT);
      EXPECT_TRUE(are_whole_with({"a" + number, "b" + number})) << whole.what_is_missing() << "\n"
                                                                << text() << logs();
    }
  }
}

// The place of the link is known where the joints are heard. The object is left there afterwards.
TEST_F(MoveItSharedCells, AttachAndDetachWhereALinkIsThatTheFirstShareDoesNotWatch) {
  start_whole();
  RosJoints joints(sender);
  ASSERT_TRUE(joints.is_heard());
  const auto moves = [&](const auto& is_so) {
    return read_until(whole, [&] {
      joints.send({"shoulder", "elbow", "push"}, {0.5, 0.0, 0.1});
      return whole.is_whole() && is_so();
    });
  };
  for (std::uint32_t pair = 0; pair < whole.catalogue()->pairs._length; ++pair)
    ASSERT_TRUE(moves([&] { return status(whole, pair) != kUnknown; })) << logs();
  const auto attached = writer_of(AttachedCollisionObject{"finger", sphere("part"), {}});
  const auto detached = writer_of(
      AttachedCollisionObject{"finger", moveit::operation(Operation::kRemove, "part"), {}});
  attached->send();
  EXPECT_TRUE(moves([&] { return text().find("to: finger") != std::string::npos; }))
      << text() << logs();
  detached->send();
  EXPECT_TRUE(moves([&] { return text().find("to: finger") == std::string::npos; }))
      << text() << logs();
  EXPECT_TRUE(has("part"));
  for (const auto& [name, daemon] : daemons) {
    EXPECT_FALSE(daemon->told("moveit-left-out")) << name << daemon->output();
    EXPECT_FALSE(daemon->told("moveit-refused")) << name << daemon->output();
  }
}

// Whichever is restarted begins with the cell file, which has none of MoveIt's objects.
TEST_F(MoveItSharedCells, AgreeAgainWithOneThatWasRestarted) {
  start_whole();
  const Writer object = writer_of(sphere("a0"));
  object->send();
  ASSERT_TRUE(are_whole_with({"a0"})) << logs();
  int count = 0;
  for (const char* share : {"left floor", "boxes", "robot", "boxes"}) {
    SCOPED_TRACE(share);
    const std::uint64_t revision = whole->scene_revision, before = daemon_of(share);
    kill_and_start(share);
    ASSERT_TRUE(read_until(whole, [&] { return daemon_of(share) != before; })) << logs();
    ASSERT_TRUE(are_whole_with({"a0"})) << whole.what_is_missing() << logs();
    EXPECT_EQ(whole->scene_revision, revision);
    const std::string next = "a" + std::to_string(++count);
    object->set(moveit::cdr_of(sphere(next, 3.0 * count)));
    EXPECT_TRUE(are_whole_after(*object, {"a0", next})) << whole.what_is_missing() << logs();
  }
}

TEST_F(MoveItSharedCells, FollowCommandsAndMessagesThatComeAtOnce) {
  start_whole();
  ChildProcess merge(kMerge, with({file.path(), "--late-ms", "500"}, dds_arguments(dds)));
  ASSERT_TRUE(read_until(whole, [&] { return merge.told("share-heard", {"robot"}); }));
  const Writer object = writer_of(sphere("a00"));
  client::Commands commands(connection, "planner");
  std::vector<std::string> names;
  double last_done = 0.0;
  for (int i = 0; i < 10; ++i) {
    names.push_back(fmt::format("a{:02}", i));
    object->set(moveit::cdr_of(sphere(names.back(), i)));
    object->send();
    const double enter = 0.2 + 0.005 * i;
    // A command that meets a message is refused, as it expects the scene before that.
    for (bool is_done = false; !is_done; std::this_thread::sleep_for(milliseconds(20))) {
      const auto result = commands.send(
          {SetZoneThresholds{.zone = "near", .enter_below = enter, .leave_above = enter + 0.1}});
      ASSERT_TRUE(result) << merge.output() << logs();
      is_done = result->done();
    }
    last_done = enter;
  }
  ASSERT_GT(last_done, 0.0) << merge.output();
  EXPECT_TRUE(
      read_until(whole,
                 [&] {
                   return whole.is_whole() &&
                          std::ranges::all_of(names, [&](const auto& name) { return has(name); }) &&
                          whole.catalogue()->zones._buffer[0].enter_below >= last_done - 1e-9;
                 }))
      << last_done << " was done\n"
      << text() << logs();
}

TEST_F(MoveItSharedCells, GoOnWhereALeadingPartnerOfTheFirstShareIsKilled) {
  start_whole({"--partner", "one"});
  ChildProcess& second = start("boxes", {"--partner", "two"}, "second");
  ASSERT_TRUE(second.tells("partner-agrees")) << logs();
  const Writer object = writer_of(sphere("a0"));
  object->send();
  ASSERT_TRUE(are_whole_with({"a0"})) << logs();
  ASSERT_TRUE(read_until(whole, [&] { return second.told("scene-changed"); })) << logs();
  object->set(moveit::cdr_of(sphere("a1", 3.0)));
  object->send();
  daemons["boxes"]->signal(SIGKILL);
  EXPECT_TRUE(are_whole_with({"a0", "a1"})) << whole.what_is_missing() << logs();
  start("boxes", {"--partner", "one"});
  object->set(moveit::cdr_of(sphere("a2", 6.0)));
  EXPECT_TRUE(are_whole_after(*object, {"a0", "a1", "a2"})) << whole.what_is_missing() << logs();
}

TEST_F(MoveItSharedCells, TheCellOfTheFirstShareIsReadAgainAndNotThatOfAnother) {
  start_whole();
  std::ofstream(file.path(), std::ios::app) << "# another text\n";
  const std::uint64_t before = whole->scene_revision, after = file.cell().scene.revision;
  daemons["robot"]->signal(SIGHUP);
  EXPECT_TRUE(read_until(
      whole, [&] { return daemons["robot"]->told("scene-refused", {"the share 'boxes'"}); }));
  EXPECT_EQ(whole->scene_revision, before);
  daemons["boxes"]->signal(SIGHUP);
  EXPECT_TRUE(read_until(whole, [&] { return whole.is_whole() && whole->scene_revision == after; }))
      << whole.what_is_missing() << logs();
}

// Each daemon has a folder of its own, as on a machine of its own.
class MoveItSharesOnMachines : public MoveItSharedCells {
 protected:
  void start_there(const std::string& share) {
    const auto there = folder / share;
    std::filesystem::create_directories(there);
    std::filesystem::copy_file(file.path(), there / "cell.yaml",
                               std::filesystem::copy_options::overwrite_existing);
    daemons[share] = std::make_unique<ChildProcess>(
        kDaemon, with({(there / "cell.yaml").string(), "--share", share}, dds_arguments(dds)));
  }
  void start_all_there() {
    for (const Share& share : cell.shares.all) start_there(share.name);
    ASSERT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
  }
  static CollisionObject tetrahedron(const std::string& name, double size) {
    CollisionObject object = sphere(name);
    object.primitives.clear();
    object.meshes = {{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}},
                      {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}}}};
    return object;
  }
  const ScratchFolder folder;
};

TEST_F(MoveItSharesOnMachines, KeepTheMeshesOfMessages) {
  start_all_there();
  writer_of(tetrahedron("wedge", 0.2))->send();
  EXPECT_TRUE(are_whole_with({"wedge"})) << whole.what_is_missing() << logs();
}

TEST_F(MoveItSharesOnMachines, AreNotWholeUntilTheOneThatLacksAMeshHasIt) {
  start_all_there();
  daemons["robot"]->signal(SIGKILL);
  daemons["robot"]->wait();
  daemons.erase("robot");
  writer_of(tetrahedron("wedge", 0.2))->send();
  ASSERT_TRUE(read_until(whole, [&] { return has("wedge"); })) << logs();
  start_there("robot");
  ASSERT_TRUE(read_until(whole, [&] {
    return daemons["robot"]->told("share-scene-refused", {"'boxes'"});
  })) << logs();
  ASSERT_TRUE(
      read_until(whole, [&] { return whole.shares()[2].state == ShareState::kOtherRevision; }));
  EXPECT_EQ(whole.what_is_missing(), "the share 'robot' is of another revision");
  EXPECT_EQ(whole->lower_all, -kInfinity);
  std::filesystem::copy(
      folder / "boxes" / "clearance.sent", folder / "robot" / "clearance.sent",
      std::filesystem::copy_options::recursive | std::filesystem::copy_options::overwrite_existing);
  EXPECT_TRUE(are_whole_with({"wedge"})) << whole.what_is_missing() << logs();
}

TEST_F(MoveItSharedCells, SayThatACatalogueOfTheFirstShareIsCorrupt) {
  start_whole();
  const dds_entity_t writer =
      sender.writer(TopicKind::kCatalogue, share_topic(cell.topics.catalogue, "boxes"));
  Sample<clearance_msg_Catalogue> corrupt;
  corrupt->daemon = 1;
  for (char** text : {&corrupt->scene, &corrupt->cell_yaml, &corrupt->cell_hash, &corrupt->build})
    *text = dds_string_dup("");
  EXPECT_TRUE(read_until(whole, [&] {
    EXPECT_EQ(dds_write(writer, &*corrupt), DDS_RETCODE_OK);
    return daemons["left floor"]->told("share-catalogue-refused", {"'boxes'", "as corrupt"}) &&
           daemons["robot"]->told("share-catalogue-refused", {"'boxes'", "as corrupt"});
  })) << logs();
  EXPECT_FALSE(daemons["boxes"]->told("share-catalogue-refused"));
  EXPECT_TRUE(read_until(whole, [&] { return whole.is_whole(); })) << logs();
}

}  // namespace
}  // namespace clearance::test
