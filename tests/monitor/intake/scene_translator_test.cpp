// MoveIt's messages as changes of a cell.
//
// Oracles: transforms by Eigen's matrices, and cells that are written by hand.
#include "monitor/intake/scene_translator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/monitor/intake/moveit_cell.hpp"

namespace clearance::moveit {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kNear = 1e-12;

Eigen::Isometry3d matrix(const Pose& pose) {
  return Eigen::Translation3d(pose.position) * pose.orientation;
}

void expect_at(const Pose& pose, const Eigen::Isometry3d& expected) {
  EXPECT_LT((matrix(pose).matrix() - expected.matrix()).cwiseAbs().maxCoeff(), kNear)
      << matrix(pose).matrix() << "\nexpected\n"
      << expected.matrix();
}

const Pose kPlace = {{0.5, -1.5, 0.25}, test::turned({1.0, 2.0, 3.0}, 0.7)};
const Pose kInObject = {{0.1, 0.2, -0.3}, test::turned({-1.0, 0.5, 2.0}, -1.1)};

TEST_F(MoveItCell, AnAddedObjectIsThePoseOfTheObjectTimesThePosesOfItsParts) {
  CollisionObject message = box_object("shelf", kPlace);
  message.primitives.push_back({SolidPrimitive::kCylinder, {0.8, 0.05}});
  message.primitives.push_back({SolidPrimitive::kSphere, {0.07}});
  message.primitive_poses = {kInObject, test::at(0, 0, 0.4)};  // the sphere has none
  EXPECT_THAT(send(message).refused, IsEmpty());
  const Object* shelf = object("shelf");
  ASSERT_NE(shelf, nullptr);
  EXPECT_TRUE(shelf->fixed);
  EXPECT_THAT(shelf->groups, ElementsAre("moveit"));
  ASSERT_EQ(shelf->parts.size(), 3u);
  const Eigen::Isometry3d place = matrix(kPlace);
  const auto part = [&](std::size_t i) {
    return compose(shelf->world_from_object, shelf->parts[i].object_from_part);
  };
  expect_at(part(0), place * matrix(kInObject));
  expect_at(part(1), place * Eigen::Translation3d(0, 0, 0.4));
  expect_at(part(2), place);
  // The support of the box along its axes, and of the cylinder along z.
  const auto& corners = shelf->parts[0].shape.anchors;
  for (const Vec3& corner : corners)
    EXPECT_LT((corner.cwiseAbs() - Vec3(0.05, 0.1, 0.15)).norm(), kNear);
  EXPECT_NEAR(shelf->parts[1].shape.bounding_radius, std::hypot(0.4, 0.05), 1e-9);
  EXPECT_EQ(shelf->parts[2].shape.radius, 0.07);
  EXPECT_TRUE(watches("hand", "shelf"));
  EXPECT_EQ(cell_.scene.zones[0].pairs.size(), 1u);
}

TEST_F(MoveItCell, AnObjectWithoutAPoseTakesThatOfItsOnlyShape) {
  CollisionObject message = box_object("shelf", Pose{});
  message.primitive_poses = {kPlace};
  send(message);
  expect_at(object("shelf")->world_from_object, matrix(kPlace));
  expect_at(object("shelf")->parts[0].object_from_part, Eigen::Isometry3d::Identity());
  // Afterwards MOVE places the shape.
  CollisionObject move = operation(Operation::kMove, "shelf");
  move.pose = kInObject;
  send(move);
  expect_at(object("shelf")->world_from_object, matrix(kInObject));
}

TEST_F(MoveItCell, PosesAreInTheFrameOfTheHeader) {
  CollisionObject in_tip = box_object("a", kPlace);
  in_tip.frame_id = "/tip";
  send(in_tip);
  expect_at(object("a")->world_from_object, matrix(poses_["tip"]) * matrix(kPlace));
  CollisionObject in_a = box_object("b", kInObject);
  in_a.frame_id = "a";
  send(in_a);
  expect_at(object("b")->world_from_object,
            matrix(poses_["tip"]) * matrix(kPlace) * matrix(kInObject));
  CollisionObject in_table = box_object("c", kInObject);
  in_table.frame_id = "table";
  send(in_table);
  expect_at(object("c")->world_from_object, Eigen::Translation3d(0, 5, 0) * matrix(kInObject));
  CollisionObject in_base = box_object("d", kInObject);
  in_base.frame_id = "base";
  send(in_base);
  expect_at(object("d")->world_from_object, matrix(kInObject));
}

TEST_F(MoveItCell, FixedFramesAndSubframesAreKeptBetweenMessages) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.fixed_frame_transforms = {{"map", "map", Pose{}}, {"bench", "map", kPlace}};
  EXPECT_THAT(send(scene).refused, IsEmpty());
  CollisionObject jig = box_object("jig", kInObject);
  jig.frame_id = "bench";
  jig.subframe_names = {"pin"};
  jig.subframe_poses = {test::at(0, 0, 0.15)};
  send(jig);
  const Eigen::Isometry3d place = matrix(kPlace) * matrix(kInObject);
  expect_at(object("jig")->world_from_object, place);
  CollisionObject on_pin = box_object("part", kInObject);
  on_pin.frame_id = "jig/pin";
  send(on_pin);
  expect_at(object("part")->world_from_object,
            place * Eigen::Translation3d(0, 0, 0.15) * matrix(kInObject));
  // A scene that is no diff forgets them.
  send(PlanningScene{});
  EXPECT_EQ(refused(jig), "header.frame_id");
  EXPECT_EQ(refused(on_pin), "header.frame_id");
}

TEST_F(MoveItCell, AddOfAPresentObjectReplacesItAndAppendAddsParts) {
  send(box_object("shelf", kPlace));
  CollisionObject ball = box_object("shelf", test::at(1, 2, 3));
  ball.primitives = {{SolidPrimitive::kSphere, {0.25}}};
  send(ball);
  ASSERT_EQ(object("shelf")->parts.size(), 1u);
  EXPECT_EQ(object("shelf")->parts[0].shape.radius, 0.25);
  expect_at(object("shelf")->world_from_object, matrix(test::at(1, 2, 3)));
  CollisionObject more = box_object("shelf", test::at(1, 2, 3));
  more.operation = static_cast<std::uint8_t>(Operation::kAppend);
  more.primitive_poses = {kInObject};
  send(more);
  const Object* shelf = object("shelf");
  ASSERT_EQ(shelf->parts.size(), 2u);
  const auto world = [&](std::size_t i) {
    return compose(shelf->world_from_object, shelf->parts[i].object_from_part);
  };
  expect_at(world(0), matrix(test::at(1, 2, 3)));
  expect_at(world(1), matrix(test::at(1, 2, 3)) * matrix(kInObject));
  EXPECT_EQ(names(),
            (std::vector<std::string>{"table", "cart", "shelf", "base", "hand", "finger"}));
}

TEST_F(MoveItCell, MeshesPrismsConesAndPlanesAreWhatTheMessageSays) {
  CollisionObject message = box_object("things", kPlace);
  message.primitives = {{SolidPrimitive::kCone, {0.6, 0.2}},
                        {SolidPrimitive::kPrism, {0.4}, {{0, 0}, {1, 0}, {0, 1}}}};
  message.primitive_poses = {};
  message.planes = {{0.0, 0.0, 2.0, -1.0}};  // z = 0.5
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  message.meshes = {mesh, mesh};
  message.mesh_poses = {test::at(3, 0, 0)};
  const Translation done = send(message);
  EXPECT_EQ(done.files.size(), 1u);  // of one content
  const Object* things = object("things");
  ASSERT_NE(things, nullptr);
  ASSERT_EQ(things->parts.size(), 5u);
  const auto& parts = things->parts;
  EXPECT_TRUE(parts[4].shape.is_half_space());
  EXPECT_EQ(parts[2].object_from_part.position, Vec3(3, 0, 0));
  EXPECT_NEAR(parts[0].shape.bounding_radius, std::hypot(0.3, 0.2), 1e-9);
  std::vector<Vec3> corners = parts[1].shape.anchors;
  ASSERT_EQ(corners.size(), 6u);
  for (const Vec3& corner : corners) EXPECT_NEAR(std::abs(corner.z()), 0.2, kNear);
  corners = parts[2].shape.anchors;
  ASSERT_EQ(corners.size(), 4u);
  for (const Vec3& vertex : mesh.vertices) {
    const auto near = [&](const Vec3& corner) { return (corner - vertex).norm() < 1e-6; };
    EXPECT_TRUE(std::ranges::any_of(corners, near)) << vertex.transpose();
  }
}

TEST_F(MoveItCell, PickAndPlaceGivesTheCellThatAPersonWouldWrite) {
  send(box_object("part", test::at(2.0, 1.0, 0.5)));
  AttachedCollisionObject attach;
  attach.link_name = "hand";
  attach.object = operation(Operation::kAdd, "part");
  attach.touch_links = {"hand", "finger", "tip"};
  attach.weight = 1.5;
  EXPECT_THAT(send(attach).refused, IsEmpty());
  EXPECT_EQ(object("part")->mass, 1.5);
  const RobotBase* base = carried("part");
  ASSERT_NE(base, nullptr);
  EXPECT_EQ(cell_.scene.robots[base->robot].links[base->link].name, "hand");
  expect_at(base->base_from_root, matrix(poses_["hand"]).inverse() * matrix(test::at(2, 1, 0.5)));
  EXPECT_FALSE(watches("finger", "part"));
  EXPECT_TRUE(watches("base", "part"));
  EXPECT_TRUE(watches("part", "table"));
  const Eigen::Isometry3d in_hand = matrix(base->base_from_root);

  // MoveIt's world has it no longer, so REMOVE there changes nothing.
  EXPECT_EQ(refused(operation(Operation::kRemove, "part")), "id");
  poses_["hand"] = {{2.0, 0.0, 0.0}, test::turned(Vec3::UnitZ(), -0.5)};
  AttachedCollisionObject detach = attach;
  detach.object.operation = static_cast<std::uint8_t>(Operation::kRemove);
  EXPECT_THAT(send(detach).refused, IsEmpty());
  EXPECT_TRUE(object("part")->fixed);
  expect_at(object("part")->world_from_object, matrix(poses_["hand"]) * in_hand);
  EXPECT_TRUE(watches("finger", "part"));

  CollisionObject move = operation(Operation::kMove, "part");
  move.pose = test::at(1.0, -2.0, 0.75);
  send(move);
  std::string by_hand = kMoveItCell;
  by_hand.insert(by_hand.find("pairs:\n"),
                 "  - {name: part, groups: [moveit], fixed: true, parts: [{box: {size: [100, 200, "
                 "300]}}], pose: {xyz: [1000, -2000, 750]}, mass: 1.5}\n");
  EXPECT_EQ(cell_.yaml, by_hand);

  send(operation(Operation::kRemove, "part"));
  EXPECT_EQ(cell_.yaml, kMoveItCell);
}

TEST_F(MoveItCell, AnObjectWithShapesIsAttachedWhereTheMessageHasIt) {
  AttachedCollisionObject message;
  message.link_name = "tip";
  message.object = box_object("tool", kPlace);
  message.object.frame_id = "hand";
  message.touch_links = {"hand"};
  send(message);
  ASSERT_NE(carried("tool"), nullptr);
  expect_at(compose(test::at(-1, 0, 0), carried("tool")->base_from_root),
            Eigen::Translation3d(-2, 0, 0) * matrix(kPlace));
  // The same at another place, then with one more part in the frame of the object.
  message.object.pose = kInObject;
  message.object.frame_id = "tip";
  send(message);
  expect_at(carried("tool")->base_from_root, matrix(kInObject));
  message.object.operation = static_cast<std::uint8_t>(Operation::kAppend);
  message.object.pose = Pose{};
  message.object.primitives = {{SolidPrimitive::kSphere, {0.01}}};
  message.object.primitive_poses = {kPlace};
  message.touch_links = {"finger"};
  EXPECT_EQ(refused(message), "object.pose") << "MoveIt loses the pose of an only shape";
  message.object.primitives.push_back({SolidPrimitive::kSphere, {0.02}});
  EXPECT_EQ(object("tool")->mass, kInfinity);
  message.weight = 2.5;
  send(message);
  EXPECT_EQ(object("tool")->mass, 2.5) << "of all its parts";
  expect_at(carried("tool")->base_from_root, matrix(kInObject));
  ASSERT_EQ(object("tool")->parts.size(), 3u);
  expect_at(object("tool")->parts[1].object_from_part, matrix(kPlace));
  EXPECT_FALSE(watches("finger", "tool"));
  EXPECT_FALSE(watches("hand", "tool"));
  EXPECT_TRUE(watches("base", "tool"));
}

TEST_F(MoveItCell, DetachWithoutANameDetachesWhatMoveItAttachedToThatLink) {
  for (const char* name : {"a", "b"}) {
    AttachedCollisionObject message;
    message.link_name = "hand";
    message.object = box_object(name, kPlace);
    send(message);
  }
  AttachedCollisionObject other;
  other.link_name = "base";
  other.object = box_object("c", kPlace);
  send(other);
  AttachedCollisionObject detach;
  detach.link_name = "hand";
  detach.object.operation = static_cast<std::uint8_t>(Operation::kRemove);
  EXPECT_EQ(send(detach).changes.size(), 2u);
  EXPECT_TRUE(object("a")->fixed);
  EXPECT_TRUE(object("b")->fixed);
  EXPECT_EQ(known_scene(cell_).objects.at("c").where, KnownObject::Where::kAttached);
}

TEST_F(MoveItCell, AWholeSceneReplacesWhatMoveItAddedAndNothingElse) {
  send(box_object("old", kPlace));
  send(box_object("stays", kPlace));
  AttachedCollisionObject attached;
  attached.link_name = "hand";
  attached.object = box_object("held", kPlace);
  send(attached);
  PlanningScene scene;
  scene.collision_objects = {box_object("stays", kInObject), box_object("new", kPlace),
                             box_object("held", kInObject)};
  EXPECT_THAT(send(scene).refused, IsEmpty());
  EXPECT_EQ(object("old"), nullptr);
  expect_at(object("stays")->world_from_object, matrix(kInObject));
  EXPECT_NE(object("new"), nullptr);
  EXPECT_TRUE(object("held")->fixed);
  send(PlanningScene{});
  EXPECT_EQ(cell_.yaml, kMoveItCell);
}

TEST_F(MoveItCell, ADiffKeepsTheWorldAndDropsAttachedObjectsUnlessTheRobotStateIsADiffToo) {
  send(box_object("shelf", kPlace));
  AttachedCollisionObject attached;
  attached.link_name = "hand";
  attached.object = box_object("held", kPlace);
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.attached = {attached};
  send(scene);
  scene.attached = {};
  send(scene);
  EXPECT_NE(object("held"), nullptr);
  scene.robot_state_is_diff = false;
  send(scene);
  EXPECT_EQ(object("held"), nullptr);
  EXPECT_NE(object("shelf"), nullptr);
}

TEST_F(MoveItCell, ThePairsThatTheMatrixAllowsAreLeftOutWhileItDoes) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.allowed_collision_matrix.entry_names = {"hand", "later", "table"};
  scene.allowed_collision_matrix.entry_values = {
      {false, true, false}, {true, false, false}, {false, false, false}};
  scene.allowed_collision_matrix.default_entry_names = {"finger"};
  scene.allowed_collision_matrix.default_entry_values = {true};
  send(scene);
  EXPECT_TRUE(watches("hand", "table"));
  EXPECT_FALSE(watches("finger", "table"));
  send(box_object("later", kPlace));  // the matrix was there before the object
  EXPECT_FALSE(watches("hand", "later"));
  EXPECT_FALSE(watches("finger", "later"));

  // A touch link makes an exception needless, and detaching makes it needed again.
  AttachedCollisionObject attach;
  attach.link_name = "hand";
  attach.object = operation(Operation::kAdd, "later");
  attach.touch_links = {"finger"};
  EXPECT_THAT(send(attach).refused, IsEmpty());
  attach.object.operation = static_cast<std::uint8_t>(Operation::kRemove);
  EXPECT_THAT(send(attach).refused, IsEmpty());
  EXPECT_FALSE(watches("hand", "later"));

  scene.allowed_collision_matrix.entry_values[0][1] = false;
  scene.allowed_collision_matrix.entry_values[1][0] = false;
  scene.allowed_collision_matrix.default_entry_values = {false};
  send(scene);
  EXPECT_TRUE(watches("hand", "later"));
  EXPECT_TRUE(watches("finger", "table"));
  send(operation(Operation::kRemove, "later"));
  EXPECT_EQ(cell_.yaml, kMoveItCell);
}

TEST_F(MoveItCell, APaddingIsTheMarginOfItsLinkWhileItIsMoreThanTheCells) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.link_padding = {{"hand", 0.02}, {"tip", 0.03}, {"finger", 0.0}};
  EXPECT_THAT(send(scene).not_understood, IsEmpty());
  EXPECT_EQ(object("hand")->margin, 0.02);
  EXPECT_EQ(object("finger")->margin, 0.0);
  EXPECT_EQ(object("base")->margin, 0.0);
  EXPECT_THAT(send(scene).changes, IsEmpty()) << "the same again";
  scene.link_padding = {{"finger", 0.01}};
  send(scene);
  EXPECT_EQ(object("hand")->margin, 0.02) << "it is not named";
  scene.link_padding = {{"hand", 0.0}, {"finger", 0.0}};
  send(scene);
  EXPECT_EQ(cell_.yaml, kMoveItCell);
}

class MoveItCellWithMargins : public MoveItCell {
 protected:
  MoveItCellWithMargins() : MoveItCell(text()) {}
  static std::string text() {
    std::string text = kMoveItCell;
    text.replace(text.find("urdf: arm.urdf"), 14, "urdf: arm.urdf, margin: 15");
    return text + "margins:\n  - {name: hand, margin: 20}\n";
  }
};

TEST_F(MoveItCellWithMargins, APaddingNeverTakesAwayWhatTheCellStates) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.link_padding = {{"hand", 0.01}, {"finger", 0.01}};
  EXPECT_THAT(send(scene).changes, IsEmpty());
  scene.link_padding = {{"hand", 0.03}, {"finger", 0.03}};
  EXPECT_THAT(send(scene).not_understood,
              ElementsAre("link_padding of 'hand', whose margin the cell states"));
  EXPECT_EQ(object("hand")->margin, 0.02);
  EXPECT_EQ(object("finger")->margin, 0.03);
  scene.link_padding = {{"hand", 0.0}, {"finger", 0.01}};
  send(scene);
  EXPECT_EQ(cell_.yaml, text());
}

TEST_F(MoveItCell, TheCellsFixedObjectsMayBeMovedAndAttachedButNotDropped) {
  CollisionObject move = operation(Operation::kMove, "table");
  move.pose = kPlace;
  send(move);
  expect_at(object("table")->world_from_object, matrix(kPlace));
  AttachedCollisionObject attach;
  attach.link_name = "hand";
  attach.object = operation(Operation::kAdd, "table");
  send(attach);
  ASSERT_NE(carried("table"), nullptr);
  send(PlanningScene{});
  EXPECT_NE(carried("table"), nullptr);
}

}  // namespace
}  // namespace clearance::moveit
