// tf may have a robot elsewhere than the cell: then it places a camera elsewhere as seen from the
// robot. Oracle: the rigid motion between the two places of the robot.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

constexpr std::int64_t kTfMs = 1'000'000;
const std::string kMast = ", mount: {frame: mast}";

// The cell has the arm's root link, `foot`, at the origin of its world, `map`.
class RobotsOnTf : public SensorsTest {
 protected:
  void make_on(const std::string& mount, const std::string& world = "map") {
    make(kImage + mount, "ros2: {world_frame: " + world + "}\n");
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  }
  void add_frame(const std::string& parent, const std::string& child, const Pose& pose,
                 std::int64_t stamp_ns) {
    const Vec3& at = pose.position;
    const Eigen::Quaterniond& turn = pose.orientation;
    add(Type::kTransforms,
        test::transforms(
            stamp_ns, stamp_ns,
            {{parent, child, {at.x(), at.y(), at.z()}, {turn.x(), turn.y(), turn.z(), turn.w()}}})
            .cdr,
        stamp_ns);
  }
  // The frames of an image after these transforms: the mast is 1 m above `parent`, and the foot is
  // at this pose in `map`.
  std::vector<SensorFrame> see(const Pose* foot, const std::string& parent = "map",
                               std::int64_t foot_until_ns = kStart + 100 * kTfMs) {
    for (std::int64_t at = kStart; at <= kStart + 100 * kTfMs; at += 10 * kTfMs) {
      sensors->add({}, test::joints(0.0, 0.0, 0.0, at), at);
      add_frame(parent, "mast", test::at(0.3, 0, 1), at);
      if (foot != nullptr && at <= foot_until_ns) add_frame("map", "foot", *foot, at);
    }
    ImageText image = flat(0, static_cast<std::uint16_t>(1000 + ++images_));
    image.stamp_ns = kStart + 75 * kTfMs;
    add(Type::kImage, image.cdr(), image.stamp_ns);
    return settle(kStart + 110 * kTfMs);
  }
  static Pose turned(double x, double angle) {
    return {{x, 0, 0}, test::turned({0.2, 0.3, 1.0}, angle)};
  }

 private:
  int images_ = 0;
};

TEST_F(RobotsOnTf, RefuseACameraThatTfPlacesInTheWorldIfTheCellHasThemElsewhere) {
  for (const Pose& foot : {turned(0.5, 0.0), turned(0.011, 0.0), turned(0.0, 0.02)}) {
    make_on(kMast);
    EXPECT_TRUE(see(&foot).empty());
    EXPECT_EQ(count(FrameFault::kRobotElsewhere), 1u);
    EXPECT_NE(sensors->status(0).robot_elsewhere.find("'foot'"), std::string::npos);
  }
  EXPECT_NE(sensors->status(0).robot_elsewhere.find("0.0 mm and 20.0 mrad"), std::string::npos);
}

TEST_F(RobotsOnTf, WidenTheErrorOfItsPlaceByASmallDifference) {
  Random random(3);
  for (const Pose& foot : {turned(0.0, 0.0), turned(0.004, 0.0), turned(-0.009, 0.008)}) {
    make_on(kMast);
    const auto frames = see(&foot);
    ASSERT_EQ(frames.size(), 1u);
    const double extent = cell.scene.sensors[0].extent(), error = frames[0].pose_error;
    EXPECT_LE(error, 0.011 + 0.011 * (extent + 2.0));
    if (foot.position.x() == 0.0) {
      EXPECT_LE(error, 1e-9);
    }
    const Eigen::Quaterniond back = foot.orientation.conjugate();
    for (int i = 0; i < 1000; ++i) {
      const Vec3 seen = Vec3(0.3, 0, 1) + extent * random.direction();
      EXPECT_LE((back * (seen - foot.position) - seen).norm(), error * (1.0 + 1e-9) + 1e-12);
    }
  }
}

// The camera is where the robot's joints and the cell have the link.
TEST_F(RobotsOnTf, DoNotMatterToACameraOnOneOfTheirLinks) {
  const Pose foot = turned(0.5, 0.0);
  make_on(kMast);
  const auto frames = see(&foot, "foot");
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].world_from_sensor.position.x(), 0.3, 1e-12);
}

TEST_F(RobotsOnTf, DoNotMatterToACameraThatTheCellPlaces) {
  const Pose foot = turned(0.5, 0.0);
  make_on(kAbove);
  EXPECT_EQ(see(&foot).size(), 1u);
}

TEST_F(RobotsOnTf, AreNotComparedIfTfHasThemNowhere) {
  make_on(kMast);
  EXPECT_EQ(see(nullptr).size(), 1u);
}

// Transforms are late, or have ended: the last one counts.
TEST_F(RobotsOnTf, AreWhereTheirLastTransformHasThem) {
  const Pose foot = turned(0.5, 0.0);
  make_on(kMast);
  EXPECT_TRUE(see(&foot, "map", kStart + 40 * kTfMs).empty());
  EXPECT_EQ(count(FrameFault::kRobotElsewhere), 1u);
}

// The description's root link is the world of tf, but the cell has the robot somewhere else in it.
TEST_F(RobotsOnTf, MayHaveARootThatIsTheWorldOfTf) {
  for (const double x : {0.0, 0.5}) {
    make_on(kMast, "foot");
    cell.scene.robots[0].base.base_from_root.position.x() = x;
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{});
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
    EXPECT_EQ(see(nullptr, "foot").size(), x == 0.0 ? 1u : 0u);
    EXPECT_EQ(count(FrameFault::kRobotElsewhere), x == 0.0 ? 0u : 1u);
  }
}

}  // namespace
}  // namespace clearance::sensors_test
