// Messages of MoveIt in a bag change the scene of the replay when they come, as in the daemon.
//
// Oracle: distances of spheres, a half-space and a planar arm by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "monitor/recording/log_recording.hpp"
#include "monitor/replay/offline_replay.hpp"
#include "monitor/replay/report_recorder.hpp"
#include "tests/monitor/intake/moveit_messages.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/shared/one_cube.hpp"

namespace clearance::test {
namespace {

using moveit::Operation;
using moveit::sphere_object;
using testing::Contains;
using testing::HasSubstr;

constexpr std::int64_t kMillisecond = 1'000'000, kBagBegin = 1'700'000'000'000'000'000;

// Ticks come every 5 ms, so that the first one after T ms is number T / 5 + 1.
const std::string kBagCell =
    "name: moveit\nunits: {length: m, angle: rad}\nrate_hz: 200\n"
    "ros2: {world_frame: map, planning_scene: true, collision_object: true, "
    "attached_collision_object: true}\n"
    "robots: [{name: arm, urdf: scara.urdf, age_limit_ms: 30}]\n"
    "objects: [{name: wall, fixed: true, half_space: {normal: [-1, 0, 0], offset: -5}}]\n"
    "pairs: [{between: [arm, arm], publish: false}, {between: [arm, wall]}, "
    "{between: [moveit, wall]}, {between: [arm, moveit]}]\n";

// Half a second at rest, then the arm swings.
double swing_at(std::int64_t ms) { return ms < 500 ? 0.0 : 1e-3 * static_cast<double>(ms - 500); }

std::vector<RosMessage> swing() {
  std::vector<RosMessage> messages;
  for (std::int64_t ms = 0; ms <= 1000; ms += 5) {
    const std::int64_t t = kBagBegin + ms * kMillisecond;
    messages.push_back(
        joint_state(t, t, {{"shoulder", "elbow", "push"}, {swing_at(ms), 0.0, 0.1}}));
  }
  return messages;
}

template <class Message>
RosMessage message_at(std::int64_t ms, const std::string& topic, const std::string& type,
                      const Message& message) {
  return {"/" + topic, "moveit_msgs/msg/" + type, kBagBegin + ms * kMillisecond,
          moveit::cdr_of(message)};
}
RosMessage object_at(std::int64_t ms, const moveit::CollisionObject& message) {
  return message_at(ms, "collision_object", "CollisionObject", message);
}
RosMessage attached_at(std::int64_t ms, const moveit::CollisionObject& message) {
  return message_at(ms, "attached_collision_object", "AttachedCollisionObject",
                    moveit::AttachedCollisionObject{"finger", message, {}});
}

class MoveItBag : public testing::Test {
 protected:
  MoveItBag() { write_text(folder / "scara.urdf", kScaraUrdf); }
  OfflineReplay replay(const std::vector<RosMessage>& more,
                       const std::function<void(const ReplayedTick&)>& on_tick = {}) {
    std::vector<RosMessage> messages = swing();
    messages.insert(messages.end(), more.begin(), more.end());
    std::ranges::stable_sort(messages, {}, &RosMessage::log_ns);
    write_mcap_bag(folder / "run.mcap", messages);
    return replay_offline(cell, folder / "run.mcap", {}, [&](const ReplayedTick& tick) {
      std::map<std::string, double> known;
      for (const PairReport& pair : tick.report.pairs) {
        if (pair.status != PairStatus::kConverged) continue;
        const ObjectPair& of = tick.cell.scene.pairs[pair.pair];
        const std::string &a = tick.cell.scene.objects[of.first].name,
                          &b = tick.cell.scene.objects[of.second].name;
        known[std::min(a, b) + "-" + std::max(a, b)] = pair.distance;
      }
      ticks.push_back(std::move(known));
      revisions.push_back(tick.cell.scene.revision);
      if (on_tick) on_tick(tick);
    });
  }
  // The distance of a pair in the tick at this time; NaN: the scene does not have it.
  double at(std::int64_t ms, const std::string& pair) const {
    const auto& tick = ticks.at(static_cast<std::size_t>(ms / 5));
    const auto found = tick.find(pair);
    return found == tick.end() ? std::nan("") : found->second;
  }

  ScratchFolder folder;
  Cell cell = [this] {
    write_text(folder / "scara.urdf", kScaraUrdf);
    return read_good(kBagCell, folder / "cell.yaml");
  }();
  std::vector<std::map<std::string, double>> ticks;
  std::vector<std::uint64_t> revisions;
};

TEST_F(MoveItBag, ChangesTheSceneTwoTicksAfterEachMessage) {
  const OfflineReplay done =
      replay({object_at(100, sphere_object("ball", "map", {4, 0, 0})),
              attached_at(200, sphere_object("part", "lower", {1.3, 0, 0})),
              attached_at(900, moveit::operation(Operation::kRemove, "part")),
              object_at(950, moveit::operation(Operation::kRemove, "ball"))});
  ASSERT_TRUE(done.ok()) << done.text();
  EXPECT_TRUE(std::isnan(at(105, "ball-finger")));
  EXPECT_NEAR(at(110, "ball-finger"), 4 - 0.1 - 2.15, 1e-9);
  EXPECT_NEAR(at(210, "part-wall"), 5 - 2.3 - 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(at(210, "finger-part"))) << "the carrier may touch it";
  EXPECT_NEAR(at(800, "part-wall"), 5 - 2.3 * std::cos(0.3) - 0.1, 1e-9);
  EXPECT_NEAR(at(800, "finger-wall"), 5 - 2.1 * std::cos(0.3) - 0.05, 1e-9);
  // The part stays where the arm was in the tick of the message.
  const Vec2 part = 2.3 * Vec2(std::cos(0.4), std::sin(0.4)),
             finger = 2.1 * Vec2(std::cos(0.5), std::sin(0.5));
  EXPECT_NEAR(at(1000, "finger-part"), (part - finger).norm() - 0.15, 1e-9);
  EXPECT_TRUE(std::isnan(at(1000, "ball-finger")));
  EXPECT_NE(revisions.back(), cell.scene.revision) << "the part is fixed";
}

TEST_F(MoveItBag, GivesTheSameBytesInTwoReplaysOfManyChanges) {
  std::vector<RosMessage> more;
  for (int i = 0; i < 12; ++i) {
    more.push_back(object_at(
        100 + 20 * i, sphere_object("ball" + std::to_string(i), "finger", {1.0 + 0.1 * i, 0, 0})));
  }
  more.push_back(object_at(600, moveit::operation(Operation::kRemove, "")));
  std::vector<std::string> bytes;
  for (int i = 0; i < 2; ++i) {
    ReportRecorder out(folder / "out.mcap", cell);
    const OfflineReplay done = replay(more, [&](const ReplayedTick& tick) { out.add(tick); });
    ASSERT_TRUE(done.ok()) << done.text();
    EXPECT_TRUE(out.close());
    bytes.push_back(read_text(folder / "out.mcap"));
  }
  EXPECT_TRUE(bytes[0] == bytes[1]);
  // Joints are still those of the first scene's ids after more changes than are kept by revision.
  EXPECT_NEAR(at(500, "ball11-finger"), 2.1 - 0.15, 1e-9);
  EXPECT_NEAR(at(1000, "finger-wall"), 5 - 2.1 * std::cos(0.5) - 0.05, 1e-9);
  EXPECT_EQ(revisions.back(), cell.scene.revision);
}

TEST_F(MoveItBag, MessagesOfOneTickAreDoneOneAfterAnother) {
  replay({object_at(100, sphere_object("a", "map", {4, 0, 0})),
          object_at(100, sphere_object("b", "a", {0, 0, 1}))});
  EXPECT_NEAR(at(110, "a-finger"), 4 - 0.1 - 2.15, 1e-9);
  EXPECT_NEAR(at(120, "b-finger"), std::hypot(1.9, 1.0) - 0.15, 1e-9);
}

TEST_F(MoveItBag, MessagesAreNamedWhereABagIsConverted) {
  replay({object_at(100, sphere_object("ball", "map", {4, 0, 0}))});
  const LogRecordingResult done = record_log(folder / "run.mcap", folder / "out.mcap", cell);
  EXPECT_THAT(done.notes, Contains(HasSubstr("/collision_object are not used")));
}

// The octomap of the scene is a sensor's. Its cube is from (4, 0, 0) to (4.1, 0.1, 0.1).
TEST_F(MoveItBag, OneTopicChangesTheSceneAndGivesASensorItsMap) {
  std::string text = kBagCell;
  text.insert(text.find("pairs:"),
              "sensors: [{name: seen, octomap: /planning_scene, range: 10, age_limit_ms: 5000}]\n");
  text.replace(text.rfind("]"), 1, ", {between: [finger, seen]}]");
  cell = read_good(text, folder / "cell.yaml");
  const auto scene_at = [](std::int64_t ms, bool has_ball) {
    moveit::PlanningScene scene;
    scene.is_diff = true;
    if (has_ball) scene.collision_objects = {sphere_object("ball", "map", {4, 0, 1})};
    RosCdr cdr;
    moveit::put(cdr, scene, one_cube({40, 0, 0}));
    return RosMessage{"/planning_scene", "moveit_msgs/msg/PlanningScene",
                      kBagBegin + ms * kMillisecond, cdr.bytes()};
  };
  replay({scene_at(100, false), scene_at(200, true), scene_at(300, false)});
  EXPECT_NEAR(at(150, "finger-seen"), 4 - 2.15, 1e-6);
  EXPECT_NEAR(at(400, "ball-finger"), std::hypot(1.9, 1.0) - 0.15, 1e-9);
  EXPECT_NEAR(at(400, "finger-seen"), 4 - 2.15, 1e-6) << "of the map after the change";
}

TEST_F(MoveItBag, WhatIsCutOffOrCannotBeUsedIsNamedAndTheRestCounts) {
  RosMessage cut = object_at(100, sphere_object("cut", "map", {4, 0, 0}));
  cut.cdr.resize(cut.cdr.size() / 2);
  const OfflineReplay done = replay({cut, object_at(150, sphere_object("lost", "moon", {4, 0, 0})),
                                     object_at(200, sphere_object("ball", "map", {4, 0, 0}))});
  ASSERT_TRUE(done.ok()) << done.text();
  EXPECT_THAT(done.notes, Contains(HasSubstr("does not decode")));
  EXPECT_THAT(done.notes, Contains(HasSubstr("header.frame_id")));
  EXPECT_NEAR(at(210, "ball-finger"), 4 - 0.1 - 2.15, 1e-9);
}

}  // namespace
}  // namespace clearance::test
