// A fault in MoveIt's messages is named by its field, and the rest of the message counts.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/monitor/intake/moveit_cell.hpp"

namespace clearance::moveit {
namespace {

using testing::ElementsAre;

const Pose kSomewhere = {{0.5, -1.5, 0.25}, test::turned({1.0, 2.0, 3.0}, 0.7)};

TEST_F(MoveItCell, MalformedMessagesAreRefusedByTheirField) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](auto change) {
    CollisionObject message = box_object("shelf", kSomewhere);
    change(message);
    return message;
  };
  using Message = CollisionObject;
  EXPECT_EQ(refused(with([](Message& m) { m.operation = 4; })), "operation");
  EXPECT_EQ(refused(with([](Message& m) { m.frame_id = "moon"; })), "header.frame_id");
  EXPECT_EQ(refused(with([](Message& m) { m.frame_id = ""; })), "header.frame_id");
  EXPECT_EQ(refused(with([](Message& m) { m.frame_id = "cart"; })), "header.frame_id");
  EXPECT_EQ(refused(with([](Message& m) { m.id = ""; })), "id");
  EXPECT_EQ(refused(with([](Message& m) { m.id = "a,b"; })), "id");
  EXPECT_EQ(refused(with([](Message& m) { m.id = "<octomap>"; })), "id");
  EXPECT_EQ(refused(with([](Message& m) { m.id = "hand"; })), "id");
  EXPECT_EQ(refused(with([](Message& m) { m.id = "table"; })), "id");
  EXPECT_EQ(refused(with([](Message& m) { m.primitives.clear(); })), "primitives");
  EXPECT_EQ(refused(with([](Message& m) { m.primitives[0].type = 9; })), "primitives[0].type");
  EXPECT_EQ(refused(with([](Message& m) { m.primitives[0].dimensions.pop_back(); })),
            "primitives[0].dimensions");
  EXPECT_EQ(refused(with([&](Message& m) { m.primitives[0].dimensions[1] = nan; })),
            "primitives[0].dimensions");
  EXPECT_EQ(refused(with([](Message& m) { m.primitives[0].dimensions[2] = 0.0; })),
            "primitives[0].dimensions");
  EXPECT_EQ(refused(with([](Message& m) {
              m.primitives[0] = {SolidPrimitive::kPrism, {1.0}};
            })),
            "primitives[0].polygon");
  EXPECT_EQ(refused(with([&](Message& m) { m.pose.position.x() = nan; })), "pose.position");
  EXPECT_EQ(refused(with([](Message& m) { m.pose.orientation.coeffs() *= 2.0; })),
            "pose.orientation");
  EXPECT_EQ(refused(with([](Message& m) { m.primitive_poses.push_back({}); })), "primitive_poses");
  EXPECT_EQ(refused(with([](Message& m) { m.planes = {{0, 0, 0, 1}}; })), "planes[0].coef");
  EXPECT_EQ(refused(with([](Message& m) {
              m.meshes.push_back({{{0, 1, 3}}, {{}, {}, {}}});
            })),
            "meshes[0].triangles[0]");
  EXPECT_EQ(refused(with([](Message& m) { m.subframe_names = {"tip"}; })), "subframe_poses");
  EXPECT_EQ(refused(operation(Operation::kRemove, "table")), "id");
  EXPECT_EQ(refused(operation(Operation::kRemove, "nothing")), "id");
  EXPECT_EQ(refused(operation(Operation::kMove, "cart")), "id");
  EXPECT_EQ(refused(operation(Operation::kMove, "hand")), "id");

  AttachedCollisionObject attach;
  attach.link_name = "hands";
  attach.object = box_object("part", kSomewhere);
  EXPECT_EQ(refused(attach), "link_name");
  attach.link_name = "finger";  // its joints are unknown
  EXPECT_EQ(refused(attach), "link_name");
  attach.link_name = "hand";
  attach.object = operation(Operation::kAdd, "part");
  EXPECT_EQ(refused(attach), "object.id");
  attach.object.planes = {{0, 0, 1, 0}};
  EXPECT_EQ(refused(attach), "object.planes");
  attach.object = operation(Operation::kMove, "part");
  EXPECT_EQ(refused(attach), "object.operation");

  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.allowed_collision_matrix.entry_names = {"hand"};
  EXPECT_EQ(refused(scene), "allowed_collision_matrix.entry_values");
  scene.allowed_collision_matrix = {};
  scene.link_padding = {{"hand", -0.01}};
  EXPECT_EQ(refused(scene), "link_padding[0].padding");
  scene.link_padding = {{"hand", nan}};
  EXPECT_EQ(refused(scene), "link_padding[0].padding");
  scene.link_padding = {};
  scene.collision_objects = {with([](Message& m) { m.primitives[0].type = 0; })};
  EXPECT_EQ(refused(scene), "world.collision_objects[0].primitives[0].type");
}

// What the reader of cells would refuse, the matrix does not ask for: its message would be lost.
TEST(WatchedPairs, ThatAMatrixMayLeaveOutAreNoneOfAPersonAndWhatMoves) {
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: deg}\nrobots:\n"
      "  - {name: anna, person: {stature: 1.7, error: 0.06}, base: {pose: {xyz: [1, 0, 0]}}}\n"
      "objects:\n  - {name: cart, max_speed: 1, sphere: {radius: 0.1}}\n"
      "  - {name: post, fixed: true, sphere: {radius: 0.1}, pose: {xyz: [0, 0, 0]}}\n"
      "pairs:\n  - {between: [anna, cart]}\n  - {between: [anna, post]}\n");
  const std::set<NamePair> pairs = watched_pairs(scene);
  EXPECT_FALSE(pairs.empty());
  for (const auto& [a, b] : pairs) EXPECT_TRUE(a == "post" || b == "post") << a << " " << b;
}

TEST_F(MoveItCell, AMatrixWithANameTwiceIsRefused) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  AllowedCollisionMatrix& matrix = scene.allowed_collision_matrix;
  matrix.entry_names = {"hand", "hand"};
  matrix.entry_values = {{true, true}, {false, false}};
  EXPECT_EQ(refused(scene), "allowed_collision_matrix.entry_names");
  matrix.entry_names = {"hand"};
  matrix.entry_values = {{false}};
  matrix.default_entry_names = {"hand", "hand"};
  matrix.default_entry_values = {true, false};
  EXPECT_EQ(refused(scene), "allowed_collision_matrix.default_entry_names");
}

TEST_F(MoveItCell, TheRestOfAMessageCountsWhereOneObjectIsRefused) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.collision_objects = {box_object("a", kSomewhere), box_object("b", kSomewhere),
                             box_object("c", kSomewhere)};
  scene.collision_objects[1].frame_id = "moon";
  const Translation done = send(scene);
  ASSERT_EQ(done.refused.size(), 1u);
  EXPECT_EQ(done.refused[0].field, "world.collision_objects[1].header.frame_id");
  EXPECT_NE(object("a"), nullptr);
  EXPECT_EQ(object("b"), nullptr);
  EXPECT_NE(object("c"), nullptr);
}

TEST_F(MoveItCell, AWholeSceneKeepsTheObjectsWhoseNewBodiesAreRefused) {
  AttachedCollisionObject attached;
  attached.link_name = "hand";
  attached.object = box_object("held", kSomewhere);
  send(attached);
  send(box_object("shelf", kSomewhere));
  send(box_object("old", kSomewhere));
  PlanningScene scene;
  scene.collision_objects = {box_object("shelf", kSomewhere)};
  scene.collision_objects[0].primitives[0].dimensions[2] = 0.0;
  scene.attached = {attached};
  scene.attached[0].object.frame_id = "moon";
  EXPECT_EQ(send(scene).refused.size(), 2u);
  EXPECT_NE(object("shelf"), nullptr);
  EXPECT_NE(object("held"), nullptr);
  EXPECT_EQ(object("old"), nullptr);
}

TEST_F(MoveItCell, ARefusedObjectKeepsItsFormerSubframes) {
  CollisionObject shelf = box_object("shelf", kSomewhere);
  shelf.subframe_names = {"tip"};
  shelf.subframe_poses = {kSomewhere};
  send(shelf);
  shelf.subframe_names = {"foot", "tip"};
  shelf.subframe_poses = {kSomewhere, kSomewhere};
  shelf.subframe_poses[1].orientation.coeffs() *= 2.0;
  EXPECT_EQ(refused(shelf), "subframe_poses[1].orientation");
  CollisionObject on_tip = box_object("on_tip", Pose{});
  on_tip.frame_id = "shelf/foot";
  EXPECT_EQ(refused(on_tip), "header.frame_id");
  on_tip.frame_id = "shelf/tip";
  EXPECT_TRUE(send(on_tip).refused.empty());
}

TEST_F(MoveItCell, WhatIsNotUnderstoodIsNamed) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.link_padding = {{"thumb", 0.01}, {"toe", 0.0}};
  scene.link_scale = {{"hand", 1.0}, {"finger", 1.1}};
  scene.has_octomap = true;
  EXPECT_THAT(send(scene).not_understood,
              ElementsAre("link_padding of 'thumb'", "link_scale of 'finger'", "world.octomap"));
}

}  // namespace
}  // namespace clearance::moveit
