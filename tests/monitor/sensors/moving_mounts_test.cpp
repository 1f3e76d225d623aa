// Cameras on frames of tf and on objects that begin to move: frames wait for what comes after their
// stamp. Oracles: the motions that the test makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "tests/monitor/bags/ros_bags.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(PastFrames, ThatBeginToMoveOrStopBetweenTwoTransformsAreWithinTheErrorOfTheirPlace) {
  Random random(11);
  for (int run = 0; run < 500; ++run) {
    // It moves on a straight way from one time to another, at any time in between.
    const double begins = random.uniform(-0.5, 1.0), ends = begins + random.uniform(0.05, 1.0);
    const double way = random.uniform(0.0, 0.5), turn = random.uniform(0.0, 2.0);
    const auto truth = [&](double s) {
      const double share = std::clamp((s - begins) / (ends - begins), 0.0, 1.0);
      Pose pose = test::at(way * share, 0, 0);
      pose.orientation = Eigen::AngleAxisd(turn * share, Vec3::UnitZ());
      return pose;
    };
    FrameHistory frames;
    for (int i = 0; i <= 10; ++i)
      frames.add("cart", "map", truth(0.1 * i), kStart + 100 * i * kMs, false);
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
    EXPECT_LE(step->shift_error, way + 1e-9);
  }
}

TEST(PastFrames, AreNotKnownWhereTheirTransformsHaveAGapOrEnd) {
  FrameHistory frames;
  frames.add("cart", "map", {}, kStart, false);
  EXPECT_TRUE(frames.step("cart", kStart));
  EXPECT_FALSE(frames.step("cart", kStart + kMs)) << "it may have begun to move";
  frames.add("cart", "map", {}, kStart + 1000 * kMs, false);
  EXPECT_TRUE(frames.step("cart", kStart + kMs));
  frames.add("cart", "map", {}, kStart + 2001 * kMs, false);
  EXPECT_FALSE(frames.step("cart", kStart + 1500 * kMs)) << "more than a second";
  EXPECT_FALSE(frames.step("cart", kStart + 2000 * kMs, 2 * kMs));
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
  for (const std::int64_t ms : {-100, -50, 0}) add_mast(0.0, kStart + ms * kMs);
  add_image(kStart + 40 * kMs);
  EXPECT_TRUE(settle(kStart + 41 * kMs).empty());
  EXPECT_TRUE(settle(kStart + 65 * kMs).empty()) << "longer than for joints";
  EXPECT_TRUE(sensors->any_waiting());
  add_mast(0.2, kStart + 50 * kMs);  // at 4 m/s, which is no leap
  const auto frames = settle(kStart + 66 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].world_from_sensor.position.x(), 0.16, 1e-9);
  EXPECT_GE(frames[0].pose_error, 0.16) << "it may still have stood at 0";
  EXPECT_LT(frames[0].pose_error, 0.17);
}

TEST_F(MovingMounts, RefuseAFrameWhoseTransformsAreLateForHalfOfItsAgeLimit) {
  make_mast();
  add_mast(0.0, kStart);
  add_image(kStart + kMs);
  EXPECT_TRUE(settle(kStart + 50 * kMs).empty());
  EXPECT_EQ(count(FrameFault::kLateTransforms), 0u);
  EXPECT_TRUE(settle(kStart + 51 * kMs).empty());
  EXPECT_EQ(count(FrameFault::kLateTransforms), 1u);
  EXPECT_FALSE(sensors->any_waiting());
  add_mast(0.1, kStart + 60 * kMs);
  EXPECT_TRUE(settle(kStart + 60 * kMs).empty()) << "it is gone";
  // A frame that is silent for a second is lost: nothing waits for it.
  add_image(kStart + 1100 * kMs);
  EXPECT_TRUE(settle(kStart + 1100 * kMs).empty());
  EXPECT_EQ(count(FrameFault::kNoPlace), 1u);
}

TEST_F(MovingMounts, WidenTheirErrorByAStatedSpeedWhereTransformsAreLate) {
  make_mast(", max_speed: 0.5, max_turn_speed: 0.1");
  add_mast(0.0, kStart - 50 * kMs);
  add_mast(0.0, kStart);
  add_image(kStart + 40 * kMs);
  EXPECT_TRUE(settle(kStart + 59 * kMs).empty()) << "it waits as for joints";
  const auto frames = settle(kStart + 60 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_NEAR(frames[0].pose_error, 0.04 * (0.5 + 0.1 * cell.scene.sensors[0].extent()), 1e-9);
  add_image(kStart + 90 * kMs);
  add_mast(0.0, kStart + 100 * kMs);
  const auto next = settle(kStart + 101 * kMs);
  ASSERT_EQ(next.size(), 1u);
  EXPECT_LT(next[0].pose_error, 1e-9);
}

TEST_F(MovingMounts, BuildTheFrameThatHasWaitedForLongestIfManyCome) {
  make_mast();
  add_mast(0.0, kStart);
  for (int i = 1; i <= 10; ++i) add_image(kStart + 4 * i * kMs);
  EXPECT_TRUE(settle(kStart + 41 * kMs).empty());
  add_mast(0.0, kStart + 6 * kMs);
  const auto frames = settle(kStart + 42 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].stamp_ns, kStart + 4 * kMs);
  add_mast(0.0, kStart + 40 * kMs);
  const auto newest = settle(kStart + 43 * kMs);
  ASSERT_EQ(newest.size(), 1u);
  EXPECT_EQ(newest[0].stamp_ns, kStart + 40 * kMs);
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
  add_image(kStart + 10 * kMs);
  EXPECT_TRUE(settle(kStart + 20 * kMs).empty()) << "it waits";
  const auto late = settle(kStart + 30 * kMs);
  ASSERT_EQ(late.size(), 1u);
  EXPECT_GT(late[0].pose_error, 0.06 * cell.scene.sensors[0].extent());
  add_image(kStart + 40 * kMs);
  add_cart(0.2, kStart + 50 * kMs);
  const auto frames = settle(kStart + 51 * kMs);
  ASSERT_EQ(frames.size(), 1u);
  const Pose& found = frames[0].world_from_sensor;
  EXPECT_NEAR(2.0 * std::atan2(found.orientation.z(), found.orientation.w()), 0.16, 1e-9);
  EXPECT_GE(frames[0].pose_error, 0.16 * cell.scene.sensors[0].extent())
      << "it may have begun to turn after the image";
}

}  // namespace
}  // namespace clearance::sensors_test
