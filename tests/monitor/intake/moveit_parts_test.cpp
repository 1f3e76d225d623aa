// Parts that MoveIt adds to an object, and poses of parts.
#include <gtest/gtest.h>

#include "tests/monitor/intake/moveit_cell.hpp"

namespace clearance::moveit {
namespace {

const Pose kPlace = {{0.5, -1.5, 0.25}, test::turned({1.0, 2.0, 3.0}, 0.7)};
const Pose kInObject = {{0.1, 0.2, -0.3}, test::turned({-1.0, 0.5, 2.0}, -1.1)};

void expect_at(const Pose& pose, const Pose& expected) {
  EXPECT_LT((pose.position - expected.position).norm(), 1e-12);
  EXPECT_LT(pose.orientation.angularDistance(expected.orientation), 1e-7);
}

// MoveIt adds them in the frame of the object, whatever the message says.
TEST_F(MoveItCell, AppendedPartsAreInTheFrameOfTheObject) {
  send(box_object("shelf", kPlace));
  CollisionObject more = box_object("shelf", Pose{});
  more.operation = static_cast<std::uint8_t>(Operation::kAppend);
  more.primitives.push_back({SolidPrimitive::kSphere, {0.25}});
  more.primitive_poses = {kInObject, test::at(1, 0, 0)};
  send(more);
  const Object* shelf = object("shelf");
  ASSERT_EQ(shelf->parts.size(), 3u);
  expect_at(shelf->world_from_object, kPlace);
  expect_at(shelf->parts[1].object_from_part, kInObject);
  expect_at(shelf->parts[2].object_from_part, test::at(1, 0, 0));
  more.pose = test::at(0, 0, 0.001);
  EXPECT_EQ(refused(more), "pose") << "MoveIt would not use it";
  more.pose = Pose{};
  more.primitives.pop_back();
  more.primitive_poses.pop_back();
  EXPECT_EQ(refused(more), "pose") << "MoveIt loses the pose of an only shape";
}

TEST_F(MoveItCell, MoveTakesThePosesOfShapesToo) {
  CollisionObject shelf = box_object("shelf", Pose{});
  shelf.primitive_poses = {kPlace};
  send(shelf);
  expect_at(object("shelf")->world_from_object, kPlace);
  // The same message with another operation moves nothing.
  shelf.operation = static_cast<std::uint8_t>(Operation::kMove);
  send(shelf);
  const auto world = [&] {
    const Object* const found = object("shelf");
    return compose(found->world_from_object, found->parts[0].object_from_part);
  };
  expect_at(world(), kPlace);
  CollisionObject moves = operation(Operation::kMove, "shelf");
  moves.pose = kPlace;
  moves.primitive_poses = {kInObject};
  send(moves);
  expect_at(object("shelf")->world_from_object, kPlace);
  expect_at(world(), compose(kPlace, kInObject));
  moves.pose = Pose{};
  moves.primitive_poses.push_back(kInObject);
  EXPECT_EQ(refused(moves), "primitive_poses") << "one too many";
  expect_at(object("shelf")->world_from_object, kPlace);
  moves.id = "table";
  moves.primitive_poses = {kInObject};
  EXPECT_EQ(refused(moves), "primitive_poses") << "of an object of the cell";
}

}  // namespace
}  // namespace clearance::moveit
