// Transforms of ROS 2 as the tick thread gets them, as poses of what follows frames, through DDS on
// loopback.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "monitor/dds/pose_reader.hpp"
#include "tests/monitor/scara_cell.hpp"
#include "tests/shared/ros_frames.hpp"

namespace clearance {
namespace {

using test::Frame;
using Kind = test::RosFrames::Kind;

constexpr double kHalf = 0.70710678118654757;  // of sqrt(2)

class RosTransformsTest : public testing::Test {
 protected:
  // A cart and a tool that follow frames, and a robot whose base does.
  static Scene framed_cell(const std::string& ros) {
    const test::ScratchFolder folder;
    test::write_text(folder / "scara.urdf", test::kScaraUrdf);
    return scene_of(
        "name: test\nunits: {length: m, angle: rad}\n" + ros +
            "robots:\n  - {name: arm, urdf: scara.urdf, prefix: r_, base: {frame: mir/top, "
            "pose: {xyz: [0, 0, 0.5]}, age_limit_ms: 300}}\n"
            "objects:\n  - {name: cart, frame: cart_link, age_limit_ms: 60, sphere: {radius: "
            "0.1}}\n"
            "  - {name: tool, frame: tool0, age_limit_ms: 60, sphere: {radius: 0.1}}\n"
            "pairs: [{between: [arm, cart]}, {between: [cart, tool]}]\n",
        folder / "cell.yaml");
  }

  explicit RosTransformsTest(const std::string& ros = "ros2: {world_frame: map}\n")
      : scene(framed_cell(ros)) {}

  // The next batch that has something of this kind.
  PoseBatch next(bool of_joints = false) {
    PoseBatch batch;
    EXPECT_TRUE(test::eventually([&] {
      const PoseBatch* came = inputs.next();
      const bool is_it =
          came != nullptr && (of_joints ? !came->joints.empty() : !came->samples.empty());
      if (is_it) batch = *came;
      return is_it;
    }));
    return batch;
  }
  // The next pose of an object that is at this place.
  bool comes_to(std::uint32_t object, const Vec3& place) {
    return test::eventually([&] {
      const PoseBatch* came = inputs.next();
      if (came == nullptr) return false;
      return std::ranges::any_of(came->samples, [&](const PoseSample& sample) {
        return sample.object == object &&
               (sample.world_from_object.position - place).norm() < 1e-12;
      });
    });
  }
  Scene scene;
  DdsOptions dds = test::own_dds();
  Participant daemon{dds}, robot{dds}, other_robot{dds};
  PoseReader inputs{scene, daemon};
};

// Objects: cart 0, tool 1.
TEST_F(RosTransformsTest, LeadThroughParentsToTheWorldWithTheStampOfTheOldest) {
  test::RosFrames frames(robot), fixed(robot, Kind::kStatic);
  ASSERT_TRUE(frames.is_heard() && fixed.is_heard());
  const std::int64_t now = dds_time();
  fixed.send({{"cart", "cart_link", {0, 0, 1}}});
  frames.send_at(now - 20'000'000, {{"map", "odom", {1, 2, 0}, {0, 0, kHalf, kHalf}}});
  frames.send_at(now - 5'000'000, {{"odom", "cart", {3, 0, 0}}, {"/nowhere", "wheel", {9, 9, 9}}});
  const PoseBatch batch = next();
  EXPECT_EQ(batch.source.view(), "/tf");
  EXPECT_EQ(batch.sequence_number, 1u);
  ASSERT_EQ(batch.samples.size(), 1u);
  const PoseSample& sample = batch.samples[0];
  EXPECT_EQ(sample.object, 0u);
  EXPECT_EQ(sample.stamp_ns, now - 20'000'000);
  // 3 m along odom's x, which is the map's y.
  EXPECT_NEAR((sample.world_from_object.position - Vec3(1, 5, 1)).norm(), 0.0, 1e-12);
  EXPECT_FALSE(sample.has_twist);
  // What does not change the stamp of the way is not news.
  frames.send_at(now - 1'000'000, {{"odom", "cart", {4, 0, 0}}});
  frames.send_at(now, {{"map", "odom", {1, 2, 0}}});
  const PoseBatch later = next();
  EXPECT_EQ(later.sequence_number, 2u);
  EXPECT_EQ(later.samples[0].stamp_ns, now - 1'000'000);
  EXPECT_NEAR((later.samples[0].world_from_object.position - Vec3(5, 2, 1)).norm(), 0.0, 1e-12);
}

// A client that is started before or after: latched, and held to be true for good.
TEST_F(RosTransformsTest, OfTfStaticHoldForGood) {
  test::RosFrames fixed(robot, Kind::kStatic);
  fixed.send({{"map", "cart_link", {0.5, 0, 0}}});
  const PoseBatch first = next(), second = next(), third = next();
  EXPECT_EQ(third.samples.at(0).world_from_object.position, Vec3(0.5, 0, 0));
  EXPECT_LT(first.samples[0].stamp_ns, second.samples.at(0).stamp_ns);
  EXPECT_LT(second.samples[0].stamp_ns, third.samples[0].stamp_ns);
}

// On tf_static, where no silence gives a frame up: a busy machine makes pauses.
TEST_F(RosTransformsTest, OfTwoPublishersOfAFrameAreTheFirstOnes) {
  test::RosFrames second(other_robot, Kind::kStatic);
  {
    test::RosFrames first(robot, Kind::kStatic);
    ASSERT_TRUE(first.is_heard() && second.is_heard());
    first.send({{"map", "cart_link", {1, 0, 0}}});
    EXPECT_TRUE(comes_to(0, {1, 0, 0}));
    double x = 1.0;
    EXPECT_TRUE(test::eventually([&] {
      first.send({{"map", "cart_link", {x += 1e-3, 0, 0}}});
      second.send({{"map", "cart_link", {2, 0, 0}}});
      const PoseBatch* came = inputs.next();
      if (came == nullptr) return false;
      EXPECT_NE(came->samples.at(0).world_from_object.position.x(), 2.0);
      return came->samples[0].world_from_object.position.x() > 1.02;
    }));
  }
  // The first one has left.
  EXPECT_TRUE(test::eventually([&] {
    second.send({{"map", "cart_link", {2, 0, 0}}});
    const PoseBatch* came = inputs.next();
    return came != nullptr && came->samples.at(0).world_from_object.position.x() == 2.0;
  }));
}

// A pose that is none leaves the frame where it was; so do circles and frames without names.
TEST_F(RosTransformsTest, ThatAreNoPosesAreRefused) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard());
  frames.send({{"map", "cart_link", {kNaN, 0, 0}},
               {"map", "cart_link", {7, 0, 0}, {0, 0, 0, 0}},
               {"map", "cart_link", {7, 0, 0}, {0, 0, 0, 1.01}},
               {"cart_link", "cart_link", {7, 0, 0}},
               {"", "cart_link", {7, 0, 0}},
               {"map", "", {7, 0, 0}}});
  frames.send({{"map", "cart_link", {8, 0, 0}}});
  EXPECT_EQ(next().samples.at(0).world_from_object.position, Vec3(8, 0, 0));
}

TEST_F(RosTransformsTest, ThatGoRoundInACircleSayNothingUntilTheyDoNot) {
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard());
  frames.send({{"a", "cart_link"}, {"b", "a"}, {"cart_link", "b"}, {"map", "tool0", {3, 0, 0}}});
  const PoseBatch of_tool = next();
  ASSERT_EQ(of_tool.samples.size(), 1u);
  EXPECT_EQ(of_tool.samples[0].object, 1u);
  // It is hung up elsewhere.
  frames.send({{"map", "b", {1, 0, 0}}});
  EXPECT_TRUE(comes_to(0, {1, 0, 0}));
}

// A tool that a gripper takes from a rack.
TEST_F(RosTransformsTest, OfAFrameWithAnotherParentAreUsedAtOnce) {
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard());
  frames.send({{"map", "rack", {1, 0, 0}}, {"map", "hand", {0, 1, 0}}, {"rack", "tool0"}});
  EXPECT_TRUE(comes_to(1, {1, 0, 0}));
  frames.send({{"map", "rack", {1, 0, 0}}, {"map", "hand", {0, 1, 0}}, {"hand", "tool0"}});
  EXPECT_TRUE(comes_to(1, {0, 1, 0}));
}

TEST_F(RosTransformsTest, WithoutAStampHoldWhenTheyWereSent) {
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard());
  const std::int64_t before = dds_time();
  frames.send_at(0, {{"map", "cart_link"}});
  const std::int64_t stamp = next().samples.at(0).stamp_ns;
  EXPECT_GE(stamp, before);
  EXPECT_LE(stamp, dds_time());
}

// Seven positions of the joint that carries the robot; q and -q are one orientation.
TEST_F(RosTransformsTest, CarryTheBaseOfARobot) {
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard());
  frames.send({{"map", "mir/top", {1, 2, 3}, {0, 0, kHalf, kHalf}}});
  const PoseBatch batch = next(true);
  EXPECT_EQ(batch.source.view(), "/tf:bases");
  const std::vector<double> expected = {1, 2, 3.5, 0, 0, kHalf, kHalf};
  ASSERT_EQ(batch.joints.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(batch.joints[i].position, expected[i], 1e-15);
    EXPECT_TRUE(scene.variables.at(batch.joints[i].variable).name.starts_with("r_arm_base/"));
    EXPECT_EQ(scene.variables[batch.joints[i].variable].age_limit_ns, 300'000'000);
  }
  frames.send({{"map", "mir/top", {1, 2, 3}, {0, 0, -kHalf, -kHalf}}});
  EXPECT_GT(next(true).joints.at(6).position, 0.0);
}

// The cell's world is a frame of the tree, not its root.
class RosTransformsToAWorld : public RosTransformsTest {
 protected:
  RosTransformsToAWorld() : RosTransformsTest("ros2: {world_frame: cell, stamps: sent}\n") {}
};

TEST_F(RosTransformsToAWorld, EndThereAndOthersAreNotUsed) {
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard());
  const std::int64_t before = dds_time();
  frames.send_at(1'000, {{"map", "cell", {100, 0, 0}},
                         {"map", "tool0", {5, 0, 0}},
                         {"cell", "cart_link", {1, 0, 0}}});
  const PoseBatch batch = next();
  ASSERT_EQ(batch.samples.size(), 1u) << "the tool hangs on the map";
  EXPECT_EQ(batch.samples[0].object, 0u);
  EXPECT_EQ(batch.samples[0].world_from_object.position, Vec3(1, 0, 0));
  EXPECT_GE(batch.samples[0].stamp_ns, before) << "stamps: sent";
}

// A robot in the world says where its links are: what hangs on one begins there.
TEST(RosTransformsOfLinks, BeginWhereTheCellHasTheRobot) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  const Scene scene = scene_of(
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: world}\n"
      "robots: [{name: arm, urdf: scara.urdf, base: {pose: {xyz: [0, 0, 2]}}}]\n"
      "objects: [{name: tool, frame: tool0, sphere: {radius: 0.1}}]\n"
      "pairs: [{between: [arm, tool]}]\n",
      folder / "cell.yaml");
  const DdsOptions dds = test::own_dds();
  Participant daemon(dds), robot(dds);
  PoseReader inputs(scene, daemon);
  test::RosFrames frames(robot);
  ASSERT_TRUE(frames.is_heard());
  frames.send({{"foot", "upper", {0, 0, 0.5}}, {"upper", "tool0", {1, 0, 0}}});
  EXPECT_TRUE(test::eventually([&] {
    const PoseBatch* came = inputs.next();
    return came != nullptr && !came->samples.empty() &&
           came->samples[0].world_from_object.position == Vec3(1, 0, 2.5);
  }));
}

}  // namespace
}  // namespace clearance
