// MoveIt's messages keep the scene of a running daemon, over real DDS.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include "monitor/client/client.hpp"
#include "monitor/intake/from_wire.hpp"
#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/shared/byte_writer.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/ros_frames.hpp"
#include "tests/shared/ros_joints.hpp"
#include "tests/shared/take_next.hpp"
#include "tests/tools/commanding_client.hpp"
#include "tests/tools/watched_daemon.hpp"

namespace clearance::test {
namespace {

using moveit::AttachedCollisionObject;
using moveit::CollisionObject;
using moveit::operation;
using moveit::Operation;
using moveit::PlanningScene;
using moveit::sphere_object;
using testing::ElementsAre;

constexpr double kNearDistance = 1e-9;

// An arm that stretches along x with a finger at 2.1 m, a wall at 5 m, a cart that follows tf, and
// a box whose poses arrive.
const std::string kKeptCell =
    "name: moveit\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
    "defaults: {age_limit_ms: 1000}\ncommands: {from: [planner]}\n"
    "capacity: {objects: 3, parts: 20, pairs: 100, bytes: 100000}\n"
    "ros2: {world_frame: map, planning_scene: true, collision_object: true, "
    "attached_collision_object: true, monitored_planning_scene: true}\n"
    "robots: [{name: arm, urdf: scara.urdf}]\n"
    "objects:\n"
    "  - {name: wall, groups: [still], fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}\n"
    "  - {name: cart, frame: cart_link, max_speed: 50, sphere: {radius: 0.1}}\n"
    "  - {name: box, max_speed: 50, box: {size: [0.2, 0.2, 0.2]}}\n"
    "pairs:\n  - {between: [arm, arm], publish: false}\n  - {between: [arm, wall]}\n"
    "  - {between: [cart, wall]}\n  - {between: [box, wall]}\n"
    "  - {between: [moveit, still]}\n  - {between: [arm, moveit]}\n"
    "zones:\n  - {name: near, between: [finger, moveit], enter_below: 0.5, leave_above: 0.55}\n";

CollisionObject as(CollisionObject object, Operation operation) {
  object.operation = static_cast<std::uint8_t>(operation);
  return object;
}

PlanningScene scene_diff() {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  return scene;
}

AttachedCollisionObject attached_to(const std::string& link, CollisionObject object) {
  return {link, std::move(object), {}};
}

class DaemonMoveIt : public WatchedDaemon {
 protected:
  using Writer = std::unique_ptr<ByteWriter>;
  void start(const std::string& text = kKeptCell, const std::vector<std::string>& more = {}) {
    watch(text, more);
    ASSERT_TRUE(joints.is_heard());
    ASSERT_TRUE(step_until(5, inputs(), [&] { return is("finger", PairStatus::kConverged); }))
        << daemon->output();
  }
  std::function<void()> inputs() {
    return [this] { joints.send({"shoulder", "elbow", "push"}, {shoulder, 0, 0.1}); };
  }
  Writer writer_of(const RosType& type, const std::string& topic,
                   const std::vector<std::byte>& cdr) {
    auto made =
        std::make_unique<ByteWriter>(client, dds.partition, *type.descriptor, "rt/" + topic, cdr);
    EXPECT_TRUE(made->is_heard() && meets_writers_of(client, *daemon));
    return made;
  }
  Writer writer_of(const CollisionObject& message) {
    return writer_of(kRosCollisionObject, "collision_object", cdr_of(message));
  }
  Writer writer_of(const AttachedCollisionObject& message) {
    return writer_of(kRosAttachedCollisionObject, "attached_collision_object", cdr_of(message));
  }
  Writer writer_of(const PlanningScene& message) {
    return writer_of(kRosPlanningScene, "planning_scene", cdr_of(message));
  }
  // Sends it once, as a program does that comes for this message alone.
  template <class Message>
  void send(const Message& message) {
    writers.push_back(writer_of(message));
    writers.back()->send();
  }

  // The pair in the last report; null if its scene has no such pair.
  const clearance_msg_PairDistance* pair_of(const std::string& a, const std::string& b) {
    return client::Pair(catalogue, a, b).in(*report);
  }
  // Waits for a known pair with this distance, m.
  bool comes(const std::string& a, const std::string& b, double distance) {
    return step_until(5, inputs(), [&] {
      const auto* pair = pair_of(a, b);
      return pair != nullptr && pair->status == static_cast<std::uint8_t>(PairStatus::kConverged) &&
             std::abs(pair->distance - distance) < kNearDistance;
    });
  }
  bool goes(const std::string& a, const std::string& b) {
    return step_until(5, inputs(), [&] {
      catalogue.update();
      return catalogue.revision() == report->scene_revision && pair_of(a, b) == nullptr;
    });
  }
  // The number of changes of the scene that the daemon has logged.
  std::size_t changes() const {
    std::size_t count = 0;
    const std::string output = daemon->output(), code = "[scene-changed]";
    for (auto at = output.find(code); at != std::string::npos; at = output.find(code, at + 1))
      ++count;
    return count;
  }
  bool changed_times(std::size_t times) {
    return step_until(5, inputs(), [&] { return changes() == times; });
  }
  // The messages that cannot be decoded, by health.
  bool is_counted_as_undecodable(std::uint64_t count) {
    client::Health health(connection);
    return step_until(5, inputs(), [&] {
      health.update();
      return health.message() != nullptr && health.message()->undecodable_samples == count;
    });
  }

  RosJoints joints{client};
  double shoulder = 0.0;
  client::Connection connection{dds};
  client::Catalogue catalogue{connection};
  std::vector<Writer> writers;
};

TEST_F(DaemonMoveIt, CollisionObjectAddsMovesAndRemoves) {
  start();
  EXPECT_TRUE(have_readers(client, dds.partition, {"rt/collision_object", "rt/planning_scene"}));
  CollisionObject ball = sphere_object("ball", "map", {4, 0, 0});
  send(ball);
  ASSERT_TRUE(comes("ball", "finger", 4 - 0.1 - 2.15)) << daemon->output();
  ball.primitives.clear();
  ball.pose.position.x() = 4.5;
  send(as(ball, Operation::kMove));
  EXPECT_TRUE(comes("ball", "finger", 4.5 - 0.1 - 2.15)) << daemon->output();
  send(as(ball, Operation::kRemove));
  EXPECT_TRUE(goes("ball", "finger")) << daemon->output();
  EXPECT_EQ(report->scene_revision, scene.revision) << "the scene is the first one again";
}

// The frame is a link, whose place only the running monitor knows.
TEST_F(DaemonMoveIt, AttachedCollisionObjectIsCarriedAndStaysWhereItIsPutDown) {
  shoulder = std::acos(0.6);
  start();
  send(attached_to("finger", sphere_object("part", "lower", {1.3, 0, 0})));
  // At 1 m + 1.3 m along the arm: x is 0.6 of that.
  ASSERT_TRUE(comes("part", "wall", 5 - 0.6 * 2.3 - 0.1)) << daemon->output();
  EXPECT_EQ(pair_of("part", "finger"), nullptr) << "the carrier may touch it";
  shoulder = 0.0;
  EXPECT_TRUE(comes("part", "wall", 5 - 2.3 - 0.1)) << daemon->output();
  send(attached_to("finger", operation(Operation::kRemove, "part")));
  ASSERT_TRUE(comes("part", "finger", 2.3 - 0.1 - 2.15)) << daemon->output();
  shoulder = 0.5;
  const double distance = std::hypot(2.3 - 2.1 * std::cos(0.5), 2.1 * std::sin(0.5));
  EXPECT_TRUE(comes("part", "finger", distance - 0.15)) << daemon->output();
}

// The scene that comes back is read by another program, which gets it late.
TEST_F(DaemonMoveIt, PlanningSceneIsInForceAndComesBackAsTheMonitoredOne) {
  start();
  PlanningScene message = scene_diff();
  message.fixed_frame_transforms = {{"bench", "map", test::at(3, 0, 0)}};
  message.collision_objects = {sphere_object("ball", "bench", {1, 0, 0})};
  message.attached = {attached_to("finger", sphere_object("part", "map", {2.3, 0, 0}))};
  message.allowed_collision_matrix = {{"ball", "upper"}, {{false, true}, {true, false}}, {}, {}};
  send(message);
  ASSERT_TRUE(comes("ball", "finger", 4 - 0.1 - 2.15)) << daemon->output();
  EXPECT_TRUE(comes("part", "wall", 5 - 2.3 - 0.1));
  EXPECT_TRUE(goes("ball", "upper")) << "the matrix allows it";
  EXPECT_EQ(changes(), 1u) << "the matrix is in force with the objects";
  EXPECT_NE(pair_of("ball", "lower"), nullptr);

  const dds_entity_t reader =
      client.ros_reader(kRosMonitoredScene, "rt/clearance/monitored_planning_scene");
  Sample<moveit_msgs_msg_dds__PlanningScene_> sample;
  PlanningScene monitored;
  const auto comes_back = [&](std::size_t objects) {
    return step_until(5, inputs(), [&] {
      if (!take_next(reader, sample)) return false;
      monitored = moveit::from_wire(*sample);
      return monitored.collision_objects.size() == objects;
    });
  };
  ASSERT_TRUE(comes_back(2));
  EXPECT_FALSE(monitored.is_diff);
  EXPECT_THAT((std::vector{monitored.collision_objects[0].id, monitored.collision_objects[1].id}),
              ElementsAre("wall", "ball"));
  EXPECT_EQ(monitored.collision_objects[1].frame_id, "map");
  EXPECT_LT((monitored.collision_objects[1].pose.position - Vec3(4, 0, 0)).norm(), kNearDistance);
  ASSERT_EQ(monitored.attached.size(), 1u);
  EXPECT_EQ(monitored.attached[0].link_name, "finger");
  EXPECT_EQ(monitored.attached[0].object.id, "part");
  EXPECT_LT((monitored.attached[0].object.pose.position - Vec3(0.2, 0, 0)).norm(), kNearDistance);

  // A whole scene without objects removes both.
  send(PlanningScene{});
  ASSERT_TRUE(comes_back(1)) << daemon->output();
  EXPECT_TRUE(monitored.attached.empty());
  EXPECT_TRUE(goes("ball", "finger"));
}

// Stamps of 0 mean that a message holds when it is sent. Ids of poses without a revision may be
// those of the scene before, so that they are refused.
TEST_F(DaemonMoveIt, TfAndJointStatesGoOnAfterAChangeAndPosesWithoutARevisionAreRefused) {
  const std::string file = (folder / "run.mcap").string();
  start(kKeptCell, {"--record", file});
  RosFrames frames(client);
  const dds_entity_t poses = client.writer(TopicKind::kPoses, read.topics.poses);
  ASSERT_TRUE(frames.is_heard() && eventually([&] { return matched_readers(poses) > 0; }));
  double cart = 1.0, box = 2.0;
  std::uint64_t number = 0;
  Sample<clearance_msg_PoseBatch> sample = make_batch(1);
  const auto send_all = [&](std::uint64_t revision) {
    return [&, revision] {
      joints.send_at(0, {"shoulder", "elbow", "push"}, {shoulder, 0, 0.1});
      frames.send_at(0, {{"map", "cart_link", {cart, 0, 0}}});
      PoseBatch batch;
      batch.source = SourceName("mover");
      batch.sequence_number = ++number;
      batch.scene_revision = revision;
      batch.samples.push_back({.object = 2,
                               .stamp_ns = SystemClock().realtime_ns(),
                               .world_from_object = at(box, 0, 0),
                               .twist = {}});
      to_wire(batch, *sample);
      ASSERT_EQ(dds_write(poses, &*sample), DDS_RETCODE_OK);
    };
  };
  const auto is_at = [&](const std::string& name, double distance) {
    const auto* pair = pair_of(name, "wall");
    return pair != nullptr && pair->status == static_cast<std::uint8_t>(PairStatus::kConverged) &&
           std::abs(pair->distance - distance) < kNearDistance;
  };
  ASSERT_TRUE(step_until(5, send_all(0), [&] {
    return is_at("cart", 5 - 1 - 0.1) && is_at("box", 5 - 2 - 0.1);
  })) << daemon->output();
  const auto ball = writer_of(sphere_object("ball", "map", {4, 0, 0}));
  ball->send();
  ASSERT_TRUE(step_until(5, send_all(0), told("refused", {"box", "another scene"})))
      << daemon->output();
  EXPECT_TRUE(is_at("cart", 5 - 1 - 0.1)) << "what was known stays known";
  cart = 1.5, box = 2.5, shoulder = 0.5;
  EXPECT_TRUE(step_until(5, send_all(0), [&] {
    return is_at("cart", 5 - 1.5 - 0.1) && is_at("finger", 5 - 2.1 * std::cos(0.5) - 0.05) &&
           pair_of("box", "wall")->status == static_cast<std::uint8_t>(PairStatus::kStale);
  })) << daemon->output();
  EXPECT_TRUE(step_until(5, send_all(scene.revision), [&] { return is_at("box", 5 - 2.5 - 0.1); }))
      << "ids of the revision before are still known: " << daemon->output();
  daemon->signal(SIGTERM);
  EXPECT_EQ(daemon->wait(), 0) << daemon->output();
  ChildProcess replay(kReplay, {"check", file, "--compare"});
  EXPECT_EQ(replay.wait(), 0) << replay.output();
}

TEST_F(DaemonMoveIt, SentTwiceIsDoneOnce) {
  start();
  const auto ball = writer_of(sphere_object("ball", "map", {4, 0, 0}));
  ball->send();
  ball->send();
  ASSERT_TRUE(comes("ball", "finger", 4 - 0.1 - 2.15)) << daemon->output();
  send(sphere_object("other", "map", {4, 1, 0}));
  EXPECT_TRUE(changed_times(2)) << "the second ball is the first one: " << daemon->output();
  EXPECT_FALSE(daemon->told("moveit-refused")) << daemon->output();
}

// Two programs with MoveIt's messages and one with commands. Each adds and removes an object.
TEST_F(DaemonMoveIt, OfTwoClientsAtOnceIsAllDoneBesideCommands) {
  start();
  const auto add_a = writer_of(sphere_object("a", "map", {4, 0, 0})),
             add_b = writer_of(sphere_object("b", "map", {4, 1, 0})),
             remove_a = writer_of(operation(Operation::kRemove, "a")),
             remove_b = writer_of(operation(Operation::kRemove, "b"));
  CommandingClient planner(client, "planner");
  planner.meet();
  ASSERT_TRUE(meets_writers_of(client, *daemon)) << daemon->output();
  for (std::size_t i = 0; i < 10; ++i) {
    const Command command = planner.command(
        {AddObject{"{name: c, groups: [moveit], fixed: true, sphere: {radius: 0.1}}"}});
    planner.send(command);
    add_a->send();
    add_b->send();
    ASSERT_TRUE(changed_times(6 * i + 3)) << daemon->output();
    EXPECT_TRUE(planner.result_of(command).done()) << planner.result_of(command).reason;
    const Command removal = planner.command({RemoveObject{"c"}});
    remove_b->send();
    planner.send(removal);
    remove_a->send();
    ASSERT_TRUE(changed_times(6 * i + 6)) << daemon->output();
    EXPECT_TRUE(planner.result_of(removal).done()) << planner.result_of(removal).reason;
  }
  EXPECT_TRUE(step_until(5, inputs(), [&] { return report->scene_revision == scene.revision; }));
}

TEST_F(DaemonMoveIt, OnATopicThatTheCellDoesNotNameIsNotHeard) {
  std::string text = kKeptCell;
  const std::string key = "collision_object: true, ";
  text.erase(text.find(key), key.size());
  start(text);
  const moveit::CollisionObject ball = sphere_object("ball", "map", {4, 0, 0});
  ByteWriter unheard(client, dds.partition, *kRosCollisionObject.descriptor, "rt/collision_object",
                     moveit::cdr_of(ball));
  PlanningScene message = scene_diff();
  message.collision_objects = {sphere_object("other", "map", {4, 0, 0})};
  send(message);
  ASSERT_TRUE(comes("other", "finger", 4 - 0.1 - 2.15)) << daemon->output();
  EXPECT_EQ(matched_readers(unheard.writer()), 0u);
}

// A message is cut off in the middle, and in its last byte. The daemon counts both, and goes on
// with the next one.
TEST_F(DaemonMoveIt, ThatIsCutOffIsCountedAndRefusedAndTheNextOneCounts) {
  start();
  const auto whole = moveit::cdr_of(sphere_object("ball", "map", {4, 0, 0}));
  std::uint64_t sent = 0;
  for (const std::size_t size : {whole.size() / 2, whole.size() - 1}) {
    const auto cut = writer_of(kRosCollisionObject, "collision_object",
                               {whole.begin(), whole.begin() + static_cast<long>(size)});
    cut->send();
    EXPECT_TRUE(is_counted_as_undecodable(++sent)) << size << daemon->output();
  }
  EXPECT_TRUE(daemon->tells("undecodable")) << daemon->output();
  EXPECT_EQ(report->scene_revision, scene.revision);
  send(sphere_object("ball", "map", {4, 0, 0}));
  EXPECT_TRUE(comes("ball", "finger", 4 - 0.1 - 2.15)) << daemon->output();
}

TEST_F(DaemonMoveIt, WithAFaultIsNamedByItsFieldAndTheRestCounts) {
  start();
  PlanningScene message = scene_diff();
  message.collision_objects = {sphere_object("lost", "moon", {4, 0, 0}),
                               sphere_object("ball", "map", {4, 0, 0})};
  send(message);
  EXPECT_TRUE(comes("ball", "finger", 4 - 0.1 - 2.15)) << daemon->output();
  EXPECT_TRUE(
      daemon->tells("moveit-left-out", {"world.collision_objects[0].header.frame_id", "'moon'"}))
      << daemon->output();
}

TEST_F(DaemonMoveIt, BeyondTheCapacityIsRefusedAndTheNextOneCounts) {
  start();
  PlanningScene message = scene_diff();
  for (const char* name : {"a", "b", "c", "d"})
    message.collision_objects.push_back(sphere_object(name, "map", {4, 0, 0}));
  message.allowed_collision_matrix = {{"a", "finger"}, {{true, true}, {true, true}}, {}, {}};
  send(message);
  EXPECT_TRUE(step_until(5, inputs(), told("moveit-refused", {"capacity"}))) << daemon->output();
  EXPECT_EQ(report->scene_revision, scene.revision) << "none of them is there";
  send(sphere_object("a", "map", {4, 0, 0}));
  EXPECT_TRUE(comes("a", "finger", 4 - 0.1 - 2.15)) << "the matrix was refused, too";
}

// The ball is 0.6 m away, and the zone begins at 0.5 m.
TEST_F(DaemonMoveIt, PaddingOfALinkEntersTheZoneThatIsNearer) {
  start();
  PlanningScene message = scene_diff();
  message.collision_objects = {sphere_object("ball", "map", {2.85, 0, 0})};
  send(message);
  ASSERT_TRUE(comes("ball", "finger", 0.6)) << daemon->output();
  client::Zones zones(connection);
  const auto is_active = [&](bool active) {
    return step_until(5, inputs(), [&] {
      zones.update();
      const auto zone = zones.states().find(0);
      return zone != zones.states().end() && zone->second.active == active;
    });
  };
  ASSERT_TRUE(is_active(false));
  message.collision_objects.clear();
  message.link_padding = {{"finger", 0.11}};
  send(message);
  EXPECT_TRUE(is_active(true)) << "0.49 m are left: " << daemon->output();
  EXPECT_TRUE(comes("ball", "finger", 0.6)) << "a distance is that of the bodies";
  message.link_padding = {{"finger", 0.04}};
  send(message);
  EXPECT_TRUE(is_active(false)) << "0.56 m are left: " << daemon->output();
}

}  // namespace
}  // namespace clearance::test
