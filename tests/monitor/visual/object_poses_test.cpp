// Poses and joints belong to the report that used them, whichever reports a viewer receives.
#include "monitor/visual/object_poses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "monitor/wire/convert.hpp"
#include "tests/monitor/tick/scara_cell.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance::test {
namespace {

using Numbers = ObjectPoses::Numbers;

// A report that used the batches of the source "arm" up to this number; 0: none in its tick.
Sample<clearance_msg_Distances> report_of(const Scene& scene, std::uint64_t number,
                                          std::int64_t newest_ns) {
  Sample<clearance_msg_Distances> wire = make_distances(scene);
  Report report;
  report.now_ns = report.newest_pose_ns = newest_ns;
  const SourceUse used{SourceName("arm"), number};
  to_wire(report, {&used, number == 0 ? 0U : 1U}, 0, *wire);
  return wire;
}

class ObjectPosesTest : public testing::Test {
 protected:
  // One batch with the hand at this height and with this stamp.
  void take(std::uint64_t number, double height, std::int64_t stamp_ns,
            std::string_view source = "arm") {
    PoseBatch batch{SourceName(source), number, scene.revision, {}};
    batch.samples.push_back(sample(0, at(0, 0, height), stamp_ns));
    poses.take(std::move(batch), Numbers::kOfSender);
  }
  void use(std::uint64_t number, std::int64_t newest_ns) {
    poses.use(*report_of(scene, number, newest_ns));
  }
  [[nodiscard]] double height() const { return poses.pose(0)->position.z(); }

  Scene scene = cell_of({moving("hand", {ball(0.1)}), fixed("box", {ball(0.1)}, at(0, 0, 7))});
  ObjectPoses poses{scene};
};

TEST_F(ObjectPosesTest, FixedObjectsAreThereAndOthersWhenTheyAreUsed) {
  EXPECT_EQ(poses.pose(1)->position.z(), 7.0);
  take(1, 0.1, 1000);
  EXPECT_EQ(poses.pose(0), nullptr);
  use(1, 1000);
  EXPECT_EQ(height(), 0.1);
}

TEST_F(ObjectPosesTest, LaterBatchesWaitForTheirReport) {
  for (std::uint64_t i = 1; i <= 5; ++i) {
    take(i, 0.1 * static_cast<double>(i), static_cast<std::int64_t>(1000 * i));
  }
  use(3, 3000);
  EXPECT_DOUBLE_EQ(height(), 0.3);
  use(5, 5000);
  EXPECT_DOUBLE_EQ(height(), 0.5);
}

// A viewer receives 60 reports per second. The report of the tick that used a batch may not be
// among them.
TEST_F(ObjectPosesTest, AReportThatNamesNoSourceSaysByItsNewestPoseWhatWasUsed) {
  take(1, 0.1, 1000);
  take(2, 0.2, 2000);
  take(3, 0.3, 3000);
  use(0, 2000);
  EXPECT_DOUBLE_EQ(height(), 0.2);
}

TEST_F(ObjectPosesTest, AnotherSourceDoesNotTakeAnObjectThatHasOne) {
  take(1, 0.1, 1000);
  take(1, 0.9, 1500, "rival");
  use(1, 2000);
  EXPECT_DOUBLE_EQ(height(), 0.1);
  take(2, 0.8, 2'000'000'000, "rival");
  use(0, 2'000'000'000);
  EXPECT_DOUBLE_EQ(height(), 0.8);
}

TEST_F(ObjectPosesTest, WhatTheDaemonRefusesIsNotShown) {
  take(1, 0.1, 1000);
  take(2, std::numeric_limits<double>::quiet_NaN(), 2000);
  use(2, 2000);
  EXPECT_DOUBLE_EQ(height(), 0.1);
}

// A daemon that has ended reports nothing, while the robot continues to send.
TEST_F(ObjectPosesTest, OfMoreThanCanWaitTheNewestAreKept) {
  for (std::uint64_t i = 1; i <= 70'000; ++i) {
    take(i, 1e-5 * static_cast<double>(i), static_cast<std::int64_t>(i));
  }
  use(1'000, 1'000);
  EXPECT_EQ(poses.pose(0), nullptr);
  use(60'000, 60'000);
  EXPECT_DOUBLE_EQ(height(), 0.6);
}

class JointPosesTest : public testing::Test {
 protected:
  static PoseBatch batch_of(double shoulder, std::uint64_t number, std::int64_t stamp_ns) {
    PoseBatch batch{SourceName("arm"), number, 0, {}};
    for (const JointSample& each : joints(shoulder, 0.0, 0.1, stamp_ns))
      batch.joints.push_back(each);
    return batch;
  }
  void take(double shoulder, std::uint64_t number, std::int64_t stamp_ns) {
    poses.take(batch_of(shoulder, number, stamp_ns), Numbers::kOfSender);
  }
  // The pose of the finger, which is 2.1 m from the foot when the elbow is straight.
  [[nodiscard]] const Pose* finger() const { return poses.pose(5); }

  Scene scene = scara_cell();
  ObjectPoses poses{scene};
};

TEST_F(JointPosesTest, LinksAreWhereTheTickHasThem) {
  ASSERT_EQ(scene.objects[5].name, "finger");
  EXPECT_EQ(finger(), nullptr);
  take(0.3, 1, kStart);
  poses.use(*report_of(scene, 1, kStart));
  ASSERT_NE(finger(), nullptr);
  EXPECT_NEAR(finger()->position.x(), 2.1 * std::cos(0.3), 1e-12);
  EXPECT_NEAR(finger()->position.y(), 2.1 * std::sin(0.3), 1e-12);

  Monitor monitor(scene);
  monitor.tick({}, joints(0.3, 0.0, 0.1, kStart), kStart);
  EXPECT_EQ(finger()->position, monitor.pose(5).position);
  EXPECT_EQ(finger()->orientation.coeffs(), monitor.pose(5).orientation.coeffs());
}

TEST_F(JointPosesTest, LaterJointsWaitForTheirReport) {
  take(0.3, 1, kStart);
  take(0.301, 2, kStart + kTick);
  poses.use(*report_of(scene, 1, kStart));
  EXPECT_NEAR(finger()->position.y(), 2.1 * std::sin(0.3), 1e-12);
  poses.use(*report_of(scene, 0, kStart + kTick));
  EXPECT_NEAR(finger()->position.y(), 2.1 * std::sin(0.301), 1e-12);
}

// Joints on a topic of ROS 2: the viewer numbers its messages differently from the daemon.
TEST_F(JointPosesTest, JointsFromElsewhereAreUsedByTheirStamps) {
  poses.take(batch_of(0.3, 1, kStart + kTick), Numbers::kUnnumbered);
  poses.use(*report_of(scene, 900, kStart));
  EXPECT_EQ(finger(), nullptr);
  poses.use(*report_of(scene, 901, kStart + kTick));
  ASSERT_NE(finger(), nullptr);
  EXPECT_NEAR(finger()->position.y(), 2.1 * std::sin(0.3), 1e-12);
}

}  // namespace
}  // namespace clearance::test
