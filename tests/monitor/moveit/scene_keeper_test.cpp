// MoveIt's messages as bytes.
//
// Oracle: CDR by its rules, field after field as MoveIt's definitions have them.
#include "monitor/moveit/scene_keeper.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/monitor/bags/ros_bags.hpp"
#include "tests/monitor/intake/heard.hpp"
#include "tests/monitor/moveit/moveit_cell.hpp"

namespace clearance::moveit {
namespace {

using test::RosCdr;

constexpr std::uint32_t kNone = 0;

void write_pose(RosCdr& cdr, const std::vector<double>& values) {
  for (const double value : values) cdr.number(value);
}

// A box 0.1 x 0.2 x 0.3 m and a tetrahedron, with a subframe, in the frame map.
void write_object(RosCdr& cdr, const std::string& id, std::uint8_t operation) {
  cdr.header(1'000'000'001, "map");
  write_pose(cdr, {1, 2, 3, 0, 0, 0.6, 0.8});
  cdr.text(id).text("key").text("db");
  cdr.number(std::uint32_t{2});  // primitives
  cdr.number(std::uint8_t{SolidPrimitive::kBox}).numbers({0.1, 0.2, 0.3}).number(kNone);
  cdr.number(std::uint8_t{SolidPrimitive::kPrism}).numbers({0.4}).number(std::uint32_t{3});
  for (const float each : {0.F, 0.F, 9.F, 1.F, 0.F, 9.F, 0.F, 1.F, 9.F}) cdr.number(each);
  cdr.number(std::uint32_t{1});
  write_pose(cdr, {0.5, 0, 0, 0, 0, 0, 1});
  cdr.number(std::uint32_t{1}).number(std::uint32_t{4});  // meshes, triangles
  for (const std::uint32_t each : {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3}) cdr.number(each);
  cdr.number(std::uint32_t{4});
  for (const double each : {0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1.}) cdr.number(each);
  cdr.number(kNone);                // mesh_poses
  cdr.number(kNone).number(kNone);  // planes and their poses
  cdr.number(std::uint32_t{1}).text("top");
  cdr.number(std::uint32_t{1});
  write_pose(cdr, {0, 0, 0.25, 0, 0, 0, 1});
  cdr.number(operation);
}

std::vector<std::byte> object_bytes() {
  RosCdr cdr;
  write_object(cdr, "shelf", 0);
  return cdr.bytes();
}

// The object that write_object() encodes.
CollisionObject expected_object(const std::string& id) {
  CollisionObject object;
  object.frame_id = "map";
  object.id = id;
  object.pose = {{1, 2, 3}, {0.8, 0, 0, 0.6}};
  object.primitives = {{SolidPrimitive::kBox, {0.1, 0.2, 0.3}},
                       {SolidPrimitive::kPrism, {0.4}, {{0, 0}, {1, 0}, {0, 1}}}};
  object.primitive_poses = {test::at(0.5, 0, 0)};
  object.meshes = {
      {{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
  object.subframe_names = {"top"};
  object.subframe_poses = {test::at(0, 0, 0.25)};
  return object;
}

std::vector<std::byte> scene_bytes() {
  RosCdr cdr;
  cdr.text("scene");
  cdr.header(0, "map")
      .number(std::uint32_t{1})
      .text("swing")
      .numbers({0.5})
      .numbers({})
      .numbers({});
  cdr.header(0, "map").number(kNone).number(kNone).number(kNone).number(kNone);  // multi-DOF joints
  cdr.number(std::uint32_t{1}).text("hand");                                     // attached
  write_object(cdr, "held", 0);
  cdr.number(std::uint32_t{2}).text("finger").text("tip");
  cdr.header(0, "").number(kNone).number(std::uint32_t{1});  // detach_posture with one point
  cdr.numbers({0.04}).numbers({}).numbers({}).numbers({}).number(std::int32_t{1}).number(kNone);
  cdr.number(2.5);              // weight
  cdr.number(std::uint8_t{1});  // robot_state.is_diff
  cdr.text("arm");
  cdr.number(std::uint32_t{1}).header(0, "bench").text("map");
  write_pose(cdr, {4, 5, 6, 0, 0, 0, 1});
  cdr.number(std::uint32_t{2}).text("hand").text("table").number(std::uint32_t{2});
  cdr.number(std::uint32_t{2}).number(std::uint8_t{0}).number(std::uint8_t{1});
  cdr.number(std::uint32_t{2}).number(std::uint8_t{1}).number(std::uint8_t{0});
  cdr.number(std::uint32_t{1}).text("finger").number(std::uint32_t{1}).number(std::uint8_t{0});
  cdr.number(std::uint32_t{1}).text("hand").number(0.01);  // link_padding
  cdr.number(std::uint32_t{1}).text("hand").number(1.5);   // link_scale
  cdr.number(std::uint32_t{1}).text("held").number(1.F).number(0.F).number(0.F).number(1.F);
  cdr.number(std::uint32_t{1});  // world
  write_object(cdr, "shelf", 0);
  cdr.header(0, "map");
  write_pose(cdr, {0, 0, 0, 0, 0, 0, 1});
  cdr.header(0, "map").number(std::uint8_t{1}).text("OcTree").number(0.1);
  cdr.number(std::uint32_t{3});
  for (const int each : {1, -1, 0}) cdr.number(static_cast<std::int8_t>(each));
  cdr.number(std::uint8_t{1});  // is_diff
  return cdr.bytes();
}

class KeptScene : public MoveItCell {
 protected:
  SceneKeeper::Work take(RawScene::Type type, const std::vector<std::byte>& bytes) {
    return keeper_.take({type, "/topic", bytes}, cell_, [this](const std::string& body) {
      const auto found = poses_.find(body);
      return found == poses_.end() ? std::nullopt : std::optional(found->second);
    });
  }
  SceneKeeper keeper_;
};

std::string yaml_of(const CellChange& change) {
  const auto* added = std::get_if<AddObject>(&change);
  return added == nullptr ? "" : added->yaml;
}

TEST_F(KeptScene, AnObjectOnTheWireIsTheObjectThatWasSent) {
  const auto work = take(RawScene::Type::kCollisionObject, object_bytes());
  const Translation expected =
      translator_.translate(expected_object("shelf"), known_scene(cell_),
                            [](const std::string&) { return std::nullopt; });
  ASSERT_EQ(work.changes.size(), 1u);
  ASSERT_EQ(expected.changes.size(), 1u);
  EXPECT_NE(yaml_of(work.changes[0]), "");
  EXPECT_EQ(yaml_of(work.changes[0]), yaml_of(expected.changes[0]));
  ASSERT_EQ(work.files.size(), 1u);
  EXPECT_EQ(work.files[0].bytes, expected.files.at(0).bytes);
  EXPECT_TRUE(work.news.empty());
}

TEST_F(KeptScene, ASceneOnTheWireIsTheSceneThatWasSent) {
  const auto work = take(RawScene::Type::kPlanningScene, scene_bytes());
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.attached = {{"hand", expected_object("held"), {"finger", "tip"}}};
  scene.fixed_frame_transforms = {{"bench", "map", test::at(4, 5, 6)}};
  scene.collision_objects = {expected_object("shelf")};
  const Translation expected = translator_.translate(
      scene, known_scene(cell_),
      [this](const std::string& body) { return std::optional(poses_.at(body)); });
  ASSERT_EQ(work.changes.size(), 2u);
  ASSERT_EQ(expected.changes.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(yaml_of(work.changes[i]), yaml_of(expected.changes[i]));
  EXPECT_THAT(work.news, testing::ElementsAre("/topic: link_padding of 'hand' is not used",
                                              "/topic: link_scale of 'hand' is not used",
                                              "/topic: world.octomap is not used"));
  // The matrix allows hand against table.
  const std::vector<CellChange> exceptions = keeper_.exceptions(cell_);
  ASSERT_EQ(exceptions.size(), 1u);
  EXPECT_EQ(std::get<SetPair>(exceptions[0]).a, "hand");
  EXPECT_EQ(std::get<SetPair>(exceptions[0]).b, "table");
  // The frame was kept, and each sentence is said once.
  EXPECT_TRUE(take(RawScene::Type::kPlanningScene, scene_bytes()).news.empty());
}

TEST_F(KeptScene, BytesThatAreCutOffAreRefused) {
  for (const auto& [type, bytes] : {std::pair(RawScene::Type::kCollisionObject, object_bytes()),
                                    std::pair(RawScene::Type::kPlanningScene, scene_bytes())}) {
    for (std::size_t size = 0; size + 4 < bytes.size(); ++size) {
      const auto work = take(type, {bytes.begin(), bytes.begin() + static_cast<long>(size)});
      EXPECT_TRUE(work.changes.empty()) << size;
    }
  }
}

TEST_F(KeptScene, IntakeHandsOnTheTopicsThatTheCellNames) {
  std::vector<RawScene> came;
  test::Heard heard(cell_, {.use_scene = [&](RawScene message) { came.push_back(message); }});
  const auto sent = [](const std::string& topic, const std::string& type) {
    return test::RosMessage{topic, "moveit_msgs/msg/" + type, 0, object_bytes()};
  };
  EXPECT_TRUE(heard.intake.hears_ros());
  EXPECT_TRUE(heard.take(sent("/collision_object", "CollisionObject")));
  EXPECT_FALSE(heard.take(sent("/collision_object", "PlanningScene")));
  EXPECT_FALSE(heard.take(sent("/other", "CollisionObject")));
  ASSERT_EQ(came.size(), 1u);
  EXPECT_EQ(came[0].type, RawScene::Type::kCollisionObject);
  EXPECT_EQ(came[0].cdr, object_bytes());
  EXPECT_EQ(heard.told(News::Cause::kTopicHeard), 1u);

  // A log names the topic, and does not use it.
  test::Heard log(cell_, {.is_log = true});
  EXPECT_FALSE(log.take(sent("/collision_object", "CollisionObject")));
  ASSERT_EQ(log.news.size(), 1u);
  EXPECT_TRUE(log.news[0].is_warning);
}

}  // namespace
}  // namespace clearance::moveit
