// MoveIt attaches and detaches a robot of the cell by its name.
//
// Oracle: transforms by Eigen's matrices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/monitor/intake/moveit_cell.hpp"

namespace clearance::moveit {
namespace {

using testing::IsEmpty;

Eigen::Isometry3d as_matrix(const Pose& pose) {
  return Eigen::Translation3d(pose.position) * pose.orientation;
}

void expect_place(const Pose& pose, const Eigen::Isometry3d& expected) {
  EXPECT_LT((as_matrix(pose).matrix() - expected.matrix()).cwiseAbs().maxCoeff(), 1e-12);
}

const Pose kDetachedAt = {{0.5, -1.5, 0.25}, test::turned({1.0, 2.0, 3.0}, 0.7)};

// The same arm once more, as the tool of the other one.
std::string cell_with_a_tool() {
  std::string text = kMoveItCell;
  text.insert(
      text.find("objects:\n"),
      "  - {name: tool, urdf: arm.urdf, prefix: t_, base: {pose: {xyz: [4000, 500, 0]}}}\n");
  return text.insert(text.find("zones:\n"), "  - {between: [tool, cells]}\n");
}

class MoveItTool : public MoveItCell {
 protected:
  MoveItTool() : MoveItCell(cell_with_a_tool()) {}
};

TEST_F(MoveItTool, IsARobotOfTheCellThatIsAttachedAndDetachedWhereItIs) {
  AttachedCollisionObject message;
  message.link_name = "tip";
  message.object = box_object("tool", Pose{});
  message.object.operation = static_cast<std::uint8_t>(Operation::kAdd);
  EXPECT_THAT(send(message).refused, IsEmpty());
  const RobotBase& base = cell_.scene.robots[1].base;
  ASSERT_EQ(base.kind, RobotBase::Kind::kLink);
  EXPECT_EQ(cell_.scene.robots[0].links[base.link].name, "tip");
  expect_place(base.base_from_root,
               as_matrix(poses_["tip"]).inverse() * as_matrix(test::at(4.0, 0.5, 0.0)));
  EXPECT_TRUE(watches("t_hand", "cart"));
  EXPECT_THAT(send(message).changes, IsEmpty()) << "it is there already";
  poses_["t_base"] = kDetachedAt;
  message.object.operation = static_cast<std::uint8_t>(Operation::kRemove);
  EXPECT_THAT(send(message).refused, IsEmpty());
  ASSERT_EQ(cell_.scene.robots[1].base.kind, RobotBase::Kind::kWorld);
  expect_place(cell_.scene.robots[1].base.base_from_root, as_matrix(kDetachedAt));
}

TEST_F(MoveItTool, IsNoObjectOfMoveItsWorld) {
  EXPECT_EQ(refused(box_object("tool", kDetachedAt)), "id");
}

}  // namespace
}  // namespace clearance::moveit
