// A robot that a camera does not see where its joints say is no input for anything.
#include <gtest/gtest.h>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "monitor/ask/completion.hpp"
#include "monitor/clouds/seen_cloud.hpp"
#include "monitor/tick/monitor.hpp"
#include "monitor/tick/read_inputs.hpp"
#include "tests/monitor/sensors/small_camera.hpp"

namespace clearance::sensors_test {
namespace {

class DeniedRobots : public testing::Test {
 protected:
  void SetUp() override {
    const std::array<MeasuredPoint, 1> point = {{{2.0F, 0.0F, 0.0F, 0.0F}}};
    ASSERT_EQ(cloud.points()->build(point, {Vec3::Zero(), 100.0}), CloudBuild::kBuilt);
    cell.scene.sensors[0].is_witness = true;
    cell.scene.sensors[0].witness_frames = 3;
    monitor.emplace(cell.scene);
  }
  // Ticks with pictures in which the robot is there, or is not.
  void see(bool is_there, int pictures) {
    for (int i = 0; i < pictures; ++i) {
      now += 10'000'000;
      std::array<JointSample, 3> joints = test::joints(0.0, 0.0, 0.0, now);
      for (JointSample& joint : joints) joint.has_velocity = true;
      const RobotsSeen seen{.there = is_there ? 1u : 0u, .not_there = is_there ? 0u : 1u};
      EXPECT_TRUE(monitor->show(
          0, {.cloud = &cloud, .stamp_ns = now, .world_from_sensor = {}, .robots = seen}));
      monitor->tick({}, joints, {now, 0});
    }
  }
  // Returns why a question about the shoulder has no input; empty: it has.
  [[nodiscard]] std::string why_not() const {
    InputState state = room_for_inputs(cell.scene);
    read_inputs(*monitor, state);
    Question question;
    question.motion = {
        .joints = {"shoulder"}, .times = {0.0, 1.0}, .positions = {0.0, 0.1}, .velocities = {}};
    question.seen = {{.sensor = "eye", .is_known = false}};
    question.poses = {{.object = "cart", .world_from_object = {}}};
    return complete(cell.scene, state, {}, question).value_or("");
  }
  [[nodiscard]] PresentPose::State link() const { return monitor->present_link(0, 1).state; }

  Cell cell = cell_with(kPoints);
  std::optional<Monitor> monitor;
  SeenCloud cloud = SeenCloud::of_points(1);
  std::int64_t now = kStart;
};

TEST_F(DeniedRobots, AreNoInputForQuestionsAttachmentsAndFramesUntilTheyAreSeenAgain) {
  see(true, 5);
  EXPECT_EQ(why_not(), "");
  EXPECT_EQ(link(), PresentPose::State::kUsable);
  see(false, 3);
  EXPECT_NE(why_not().find("the position of joint 'elbow' contradicted"), std::string::npos)
      << why_not();
  EXPECT_EQ(link(), PresentPose::State::kContradicted);
  see(true, 3);
  EXPECT_EQ(why_not(), "");
  EXPECT_EQ(link(), PresentPose::State::kUsable);
}

}  // namespace
}  // namespace clearance::sensors_test
