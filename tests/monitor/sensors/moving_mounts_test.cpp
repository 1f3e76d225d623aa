// Cameras on frames of tf and on objects that begin to move: frames wait for what comes after their
// stamp. Oracles: the motions that the test makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "monitor/sensors/mount_track.hpp"
#include "tests/monitor/recording/ros_bags.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/monitor/sensors/tf_said.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

constexpr std::int64_t kMountMs = 1'000'000;

TEST(PastFrames, ThatBeginToMoveOrStopBetweenTwoTransformsAreWithinTheErrorOfTheirPlace) {
  Random random(11);
  for (int run = 0; run < 500; ++run) {
    // The frame moves on a straight path from one time to another, at any time in between.
    const double begins = random.uniform(-0.5, 1.0), ends = begins + random.uniform(0.05, 1.0);
    const double path = random.uniform(0.0, 0.5), turn = random.uniform(0.0, 2.0);
    const auto truth = [&](double s) {
      const double share = std::clamp((s - begins) / (ends - begins), 0.0, 1.0);
      Pose pose = test::at(path * share, 0, 0);
      pose.orientation = Eigen::AngleAxisd(turn * share, Vec3::UnitZ());
      return pose;
    };
    test::TfSaid frames;
    for (int i = 0; i <= 10; ++i)
      frames.add("cart", "map", truth(0.1 * i), kStart + 100 * i * kMountMs, false);
    const double s = random.uniform(0.0, 1.0), within = run % 2 == 0 ? 0.0 : 0.15;
    const auto ns = [](double seconds) { return static_cast<std::int64_t>(seconds * 1e9); };
    const auto step = frames.step("cart", kStart + ns(s), ns(within));
    ASSERT_EQ(step.has_value(), s - within >= 0.0 && s + within <= 1.0) << s;
    if (!step) continue;
    for (const double off : {-1.0, -0.4, 0.0, 0.7, 1.0}) {
      const Pose at = truth(s + off * within), &found = step->parent_from_child;
      EXPECT_LE((at.position - found.position).norm(), step->shift_error + 1e-9);
      EXPECT_LE(at.orientation.angularDistance(found.orientation), step->turn_error + 1e-9);
    }
    EXPECT_LE(step->shift_error, path + 1e-9);
  }
}

TEST(PastFrames, AreNotKnownWhereTheirTransformsHaveAGapOrEnd) {
  test::TfSaid frames;
  frames.add("cart", "map", {}, kStart, false);
  EXPECT_TRUE(frames.step("cart", kStart));
  EXPECT_FALSE(frames.step("cart", kStart + kMountMs)) << "it may have begun to move";
  frames.add("cart", "map", {}, kStart + 1000 * kMountMs, false);
  EXPECT_TRUE(frames.step("cart", kStart + kMountMs));
  frames.add("cart", "map", {}, kStart + 2001 * kMountMs, false);
  EXPECT_FALSE(frames.step("cart", kStart + 1500 * kMountMs)) << "more than a second";
  EXPECT_FALSE(frames.step("cart", kStart + 2000 * kMountMs, 2 * kMountMs));
}

class MovingMounts : public SensorsTest {
 protected:
  // The camera is in the frame `mast`, which tf moves along x.
  void make_mast(const std::string& speed = "") {
    make(kImage + ", mount: {frame: mast" + speed + "}", "ros2: {world_frame: map}\n");
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  }
  void add_mast(double x, std::int64_t stamp_ns) {
    add(Type::kTransforms, test::transforms(stamp_ns, stamp_ns, {{"map", "mast", {x, 0, 0}}}).cdr,
        stamp_ns);
  }
  // An image with this stamp comes at once.
  void add_image(std::int64_t stamp_ns) {
    ImageText image = flat(0, static_cast<std::uint16_t>(1000 + ++images_));
    image.stamp_ns = stamp_ns;
    add(Type::kImage, image.cdr(), stamp_ns);
  }

 private:
  int images_ = 0;
};

TEST_F(MovingMounts, GiveAFrameItsPlaceWhenATransformFromAfterItsStampHasCome) {
  make_mast();
  for (const std::int64_t ms : {-100, -50, 0}) add_mast(0.0, kStart + ms * kMountMs);
  add_image(kStart + 40 * kMountMs);
  EXPECT_TRUE(settle(kStart + 41 * kMountMs).empty());
  EXPECT_TRUE(settle(kStart + 65 * kMountMs).empty()) << "longer than for joints";
  EXPECT_TRUE(sensors->any_waiting());
  add_mast(0.2, kStart + 50 * kMountMs);  // at 4 m/s, which is no leap
  const auto frames = settle(kStart + 66 * kMountMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].world_from_sensor.position.x(), 0.16, 1e-9);
  EXPECT_GE(frames[0].pose_error, 0.16) << "it may still have stood at 0";
  EXPECT_LT(frames[0].pose_error, 0.17);
}

TEST_F(MovingMounts, HaveNoPlaceByAMessageThatPlacesTheirFrameTwice) {
  make_mast();
  for (const std::int64_t ms : {-100, -50, 0}) add_mast(0.0, kStart + ms * kMountMs);
  add_image(kStart + 40 * kMountMs);
  const std::int64_t stamp_ns = kStart + 50 * kMountMs;
  const auto twice = test::transforms(stamp_ns, stamp_ns,
                                      {{"map", "mast", {0.1, 0, 0}}, {"map", "mast", {0.2, 0, 0}}});
  add(Type::kTransforms, twice.cdr, stamp_ns);
  EXPECT_TRUE(settle(kStart + 66 * kMountMs).empty());
  EXPECT_TRUE(sensors->any_waiting());
  add_mast(0.2, stamp_ns);
  EXPECT_EQ(settle(kStart + 67 * kMountMs).size(), 1u);
}

// The transform from the robot to `camera_link` is missing: it may be anywhere.
TEST_F(MovingMounts, HaveNoPlaceIfTheirPathEndsAtNoFrameOfTheCellAlsoInALog) {
  for (const char* root : {"camera_link", "world"}) {
    SCOPED_TRACE(root);
    make(kImage + ", mount: {frame: mast}");
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{.is_log = true});
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
    for (const std::int64_t ms : {0, 2})
      add(Type::kTransforms,
          test::transforms(kStart + ms * kMountMs, kStart + ms * kMountMs,
                           {{root, "mast", {0, 0, 2}}})
              .cdr,
          kStart + ms * kMountMs);
    add_image(kStart + kMountMs);
    const bool is_world = std::string(root) == "world";
    EXPECT_EQ(settle(kStart + 3 * kMountMs).size(), is_world ? 1u : 0u);
    EXPECT_EQ(count(FrameFault::kNoPlace), is_world ? 0u : 1u);
  }
}

// A frame may have the name of an object, and another origin.
TEST_F(MovingMounts, DoNotTakeTheNameOfAnObjectForAFrame) {
  for (const std::string frame : {"", "cart"}) {
    make(kImage + ", mount: {frame: mast}");
    cell.scene.objects[0].frame = frame;
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{});
    add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
    for (const std::int64_t ms : {0, 2}) {
      const std::int64_t at_ns = kStart + ms * kMountMs;
      add(Type::kTransforms, test::transforms(at_ns, at_ns, {{"cart", "mast", {0, 0, 2}}}).cdr,
          at_ns);
      sensors->add(std::vector{test::sample(0, {}, at_ns)}, {}, at_ns);
    }
    add_image(kStart + kMountMs);
    EXPECT_EQ(settle(kStart + 3 * kMountMs).size(), frame.empty() ? 0u : 1u) << frame;
  }
}

TEST_F(MovingMounts, RefuseAFrameWhoseTransformsAreLateForHalfOfItsAgeLimit) {
  make_mast();
  add_mast(0.0, kStart);
  add_image(kStart + kMountMs);
  EXPECT_TRUE(settle(kStart + 50 * kMountMs).empty());
  EXPECT_EQ(count(FrameFault::kLateTransforms), 0u);
  EXPECT_TRUE(settle(kStart + 51 * kMountMs).empty());
  EXPECT_EQ(count(FrameFault::kLateTransforms), 1u);
  EXPECT_FALSE(sensors->any_waiting());
  add_mast(0.1, kStart + 60 * kMountMs);
  EXPECT_TRUE(settle(kStart + 60 * kMountMs).empty()) << "it is gone";
  // A frame that is silent for a second is lost: nothing waits for it.
  add_image(kStart + 1100 * kMountMs);
  EXPECT_TRUE(settle(kStart + 1100 * kMountMs).empty());
  EXPECT_EQ(count(FrameFault::kNoPlace), 1u);
}

TEST_F(MovingMounts, WidenTheirErrorByAStatedSpeedWhereTransformsAreLate) {
  make_mast(", max_speed: 0.5, max_turn_speed: 0.1");
  add_mast(0.0, kStart - 50 * kMountMs);
  add_mast(0.0, kStart);
  add_image(kStart + 40 * kMountMs);
  EXPECT_TRUE(settle(kStart + 59 * kMountMs).empty()) << "it waits as for joints";
  const auto frames = settle(kStart + 60 * kMountMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].pose_error, 0.04 * (0.5 + 0.1 * cell.scene.sensors[0].extent()), 1e-9);
  add_image(kStart + 90 * kMountMs);
  add_mast(0.0, kStart + 100 * kMountMs);
  const auto next = settle(kStart + 101 * kMountMs);
  ASSERT_EQ(next.size(), 1u);
  EXPECT_LT(next[0].pose_error, 1e-9);
}

TEST_F(MovingMounts, WidenTheirErrorByTheErrorOfTheStampWhereTransformsAreLate) {
  make(kImage + ", stamp_error_ms: 5, mount: {frame: mast, max_speed: 0.5, max_turn_speed: 0.1}",
       "ros2: {world_frame: map}\n");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add_mast(0.0, kStart - 50 * kMountMs);
  add_mast(0.0, kStart);
  add_image(kStart + 40 * kMountMs);
  const auto frames = settle(kStart + 60 * kMountMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].pose_error, 0.045 * (0.5 + 0.1 * cell.scene.sensors[0].extent()), 1e-9);
}

TEST(PathMetric, ComesNoFartherThanItsSpeedsAllowAndToNoOtherCarrier) {
  const PathMetric metric{.speed = {.shift = 0.5, .turn = 0.1}};
  const Carrier base{.kind = RobotBase::Kind::kObject, .object = 1};
  const auto turned = [](double angle) {
    return Pose{Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vec3::UnitZ()))};
  };
  const CarriedPose from{base, Pose{}};
  EXPECT_TRUE(metric.stay_within(0.1, from, {base, test::at(0.049, 0, 0)}));
  EXPECT_FALSE(metric.stay_within(0.1, from, {base, test::at(0.051, 0, 0)}));
  EXPECT_TRUE(metric.stay_within(0.1, from, {base, turned(0.0099)}));
  EXPECT_FALSE(metric.stay_within(0.1, from, {base, turned(0.0101)}));
  EXPECT_FALSE(metric.stay_within(0.1, from, {Carrier{}, Pose{}}));
}

// Elements may be outside of the ball that is the body of the sensor's object.
TEST_F(MovingMounts, HaveNoPlaceIfItsErrorIsLargerThanTheBallOfTheViewAllows) {
  make_mast(", max_speed: 20, max_turn_speed: 0.1");
  const Sensor& sensor = cell.scene.sensors[0];
  for (const std::int64_t late_ms : {100, 800}) {
    add_mast(0.0, kStart);
    add_image(kStart + late_ms * kMountMs);
    const auto frames = settle(kStart + (late_ms + 30) * kMountMs);
    const bool fits = late_ms == 100;
    ASSERT_EQ(frames.size(), fits ? 1u : 0u);
    for (const SensorFrame& frame : frames)
      EXPECT_LE(sensor.extent() + frame.pose_error, sensor.view_radius());
    EXPECT_EQ(count(FrameFault::kNoPlace), fits ? 0u : 1u);
  }
}

TEST_F(MovingMounts, BuildTheFrameThatHasWaitedForLongestIfManyCome) {
  make_mast();
  add_mast(0.0, kStart);
  for (int i = 1; i <= 10; ++i) add_image(kStart + 4 * i * kMountMs);
  EXPECT_TRUE(settle(kStart + 41 * kMountMs).empty());
  add_mast(0.0, kStart + 6 * kMountMs);
  const auto frames = settle(kStart + 42 * kMountMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].stamp_ns, kStart + 4 * kMountMs);
  add_mast(0.0, kStart + 40 * kMountMs);
  const auto newest = settle(kStart + 43 * kMountMs);
  ASSERT_EQ(newest.size(), 1u);
  EXPECT_EQ(newest[0].stamp_ns, kStart + 40 * kMountMs);
}

// The cart turns at 6 rad/s at most. What the camera sees is up to 8 m away from it.
TEST_F(MovingMounts, OnAnObjectCountHowItMayHaveTurnedSinceItsLastPose) {
  make(kImage + ", mount: {on: cart}");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  const auto add_cart = [&](double angle, std::int64_t stamp_ns) {
    PoseSample sample = test::sample(cell.scene.sensors[0].mount.object, {}, stamp_ns);
    sample.world_from_object.orientation = Eigen::AngleAxisd(angle, Vec3::UnitZ());
    sensors->add(std::vector{sample}, {}, stamp_ns);
  };
  add_cart(0.0, kStart);
  add_image(kStart + 10 * kMountMs);
  EXPECT_TRUE(settle(kStart + 20 * kMountMs).empty()) << "it waits";
  const auto late = settle(kStart + 30 * kMountMs);
  ASSERT_EQ(late.size(), 1u);
  EXPECT_GT(late[0].pose_error, 0.06 * cell.scene.sensors[0].extent());
  add_image(kStart + 40 * kMountMs);
  add_cart(0.2, kStart + 50 * kMountMs);
  const auto frames = settle(kStart + 51 * kMountMs);
  ASSERT_EQ(frames.size(), 1u);
  const Pose& found = frames[0].world_from_sensor;
  EXPECT_NEAR(2.0 * std::atan2(found.orientation.z(), found.orientation.w()), 0.16, 1e-9);
  EXPECT_GE(frames[0].pose_error, 0.16 * cell.scene.sensors[0].extent())
      << "it may have begun to turn after the image";
}

}  // namespace
}  // namespace clearance::sensors_test
