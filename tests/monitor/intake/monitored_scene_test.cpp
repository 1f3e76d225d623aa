// The present scene as MoveIt's message.
//
// Oracle: the cell that becomes of an empty one when it takes the message.
#include "monitor/publish/monitored_scene.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/intake/moveit_cell.hpp"

namespace clearance::moveit {
namespace {

TEST_F(MoveItCell, ThePublishedSceneGivesTheSameSceneToAnotherCell) {
  CollisionObject message = box_object("shelf", {{0.5, -1.5, 0.25}, test::turned({1, 2, 3}, 0.7)});
  message.primitives.push_back({SolidPrimitive::kSphere, {0.07}});
  message.primitive_poses.push_back(test::at(0, 0, 0.4));
  message.planes = {{0.0, 0.0, 2.0, 8.0}};
  send(message);
  AttachedCollisionObject attached;
  attached.link_name = "hand";
  attached.object = box_object("held", test::at(2.0, 0.3, 0.0));
  attached.touch_links = {"finger"};
  attached.weight = 2.5;
  send(attached);
  const Cell first = cell_;
  const PlanningScene published = from_wire(*to_wire(monitored_scene(first)));
  EXPECT_FALSE(published.is_diff);
  ASSERT_EQ(published.collision_objects.size(), 2u);  // the table as well, and no cart
  ASSERT_EQ(published.attached.size(), 1u);
  EXPECT_EQ(published.attached[0].weight, 2.5);

  send(PlanningScene{});
  ASSERT_EQ(object("shelf"), nullptr);
  const Translation done = send(published);
  ASSERT_EQ(done.refused.size(), 1u);  // the table is the cell's
  EXPECT_EQ(done.refused[0].field, "world.collision_objects[0].id");
  for (const Object& before : first.scene.objects) {
    const Object* after = object(before.name);
    ASSERT_NE(after, nullptr) << before.name;
    EXPECT_LT((before.world_from_object.position - after->world_from_object.position).norm(),
              1e-12);
    EXPECT_EQ(before.parts.size(), after->parts.size());
  }
  const Object* shelf = object("shelf");
  EXPECT_EQ(shelf->parts[0].shape.radius, 0.07);
  EXPECT_EQ(shelf->parts[1].shape.anchors.size(), 8u);
  ASSERT_TRUE(shelf->parts[2].shape.is_half_space());
  EXPECT_NEAR(shelf->parts[2].shape.facets[0].offset, -4.0, 1e-12);
  ASSERT_NE(carried("held"), nullptr);
  EXPECT_EQ(known_scene(first).watched, known_scene(cell_).watched);
}

TEST_F(MoveItCell, ThePublishedPaddingsAreTheMarginsOfTheLinks) {
  PlanningScene scene;
  scene.is_diff = scene.robot_state_is_diff = true;
  scene.link_padding = {{"hand", 0.02}};
  send(scene);
  const PlanningScene published = from_wire(*to_wire(monitored_scene(cell_)));
  std::map<std::string, double> paddings;
  for (const LinkNumber& each : published.link_padding) paddings[each.link_name] = each.value;
  EXPECT_EQ(paddings, (std::map<std::string, double>{{"base", 0}, {"finger", 0}, {"hand", 0.02}}));
  scene.link_padding = {{"hand", 0.0}, {"finger", 0.01}};
  send(scene);
  send(published);
  EXPECT_EQ(object("hand")->margin, 0.02);
  EXPECT_EQ(object("finger")->margin, 0.0);
}

}  // namespace
}  // namespace clearance::moveit
