// Messages of a camera become frames for the tick: the place at the stamp, the robot's own image,
// and a cause for each frame that is refused.
//
// The camera has 8 x 6 pixels. Oracles: the depths and places that the test put in.
#include "monitor/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "tests/monitor/sensors/small_camera.hpp"

namespace clearance::sensors_test {
namespace {

TEST_F(SensorsTest, MakeAFrameOfAnImageWithThePlaceThatTheCellStates) {
  make(kImage + kAbove);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add(flat(0, 1000));
  const auto frames = settle(kStart + 2000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].stamp_ns, kStart);
  EXPECT_EQ(frames[0].cloud->size(), 48u);
  EXPECT_LT(frames[0].pose_error, 1e-12);
  // A ball at the origin is 1 m below the plane that all pixels see, less the error of 10 mm.
  Monitor monitor(cell.scene);
  ASSERT_TRUE(monitor.show(0, frames[0]));
  const Report& report = monitor.tick(std::vector{test::sample(0, {}, kStart)}, kStart + 1'000'000);
  for (std::size_t p = 0; p < cell.scene.pairs.size(); ++p) {
    if (cell.scene.pairs[p].first != 0) continue;
    EXPECT_NEAR(report.pairs[p].lower, 1.0 - 0.01 - 0.1, 1e-6);
  }
}

TEST_F(SensorsTest, UseAnImageThatCameBeforeItsFirstCameraInfo) {
  make(kImage + kAbove);
  add(flat(0, 1000));
  EXPECT_TRUE(settle(kStart + 1000).empty());
  EXPECT_EQ(count(FrameFault::kNoCameraInfo), 0u) << "it waits";
  add(flat(1, 1010));
  EXPECT_EQ(count(FrameFault::kNoCameraInfo), 1u) << "the second one has replaced it";
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart + kFrame + 2000);
  EXPECT_EQ(settle(kStart + kFrame + 3000).size(), 1u);
  EXPECT_EQ(count(FrameFault::kNoCameraInfo), 1u);
}

// Once infos have come with the stamps of images, an image is not used with the info before its
// own: the camera may have changed in between.
TEST_F(SensorsTest, WaitForTheCameraInfoOfAnImagesOwnStamp) {
  make(kImage + kAbove);
  const auto add_info = [&](int number, double focal_length) {
    InfoText info;
    info.stamp_ns = kStart + number * kFrame;
    info.k[0] = info.p[0] = focal_length;
    add(Type::kCameraInfo, info.cdr(), info.stamp_ns + 2000);
  };
  const auto add_image = [&](int number) {
    add(flat(number, static_cast<std::uint16_t>(1000 + 10 * number)));
  };
  const auto settled = [&](int number, std::int64_t after_ns = 3000) {
    return settle(kStart + number * kFrame + after_ns).size();
  };
  add_info(0, 10);
  for (int i = 0; i < 2; ++i) {
    add_image(i);
    EXPECT_EQ(settled(i), 1u) << "whether infos come with images is not known yet";
    add_info(i, 10);
  }
  add_image(2);
  EXPECT_EQ(settled(2), 0u);
  add_info(2, 10);
  EXPECT_EQ(settled(2), 1u);
  add_info(3, 10);
  add_image(3);
  EXPECT_EQ(settled(3), 1u) << "its info came first";
  add_image(4);
  EXPECT_EQ(settled(4), 0u);
  EXPECT_EQ(settled(4, 21'000'000), 1u) << "its info is lost";
  add_image(5);
  add_info(5, 12);
  EXPECT_EQ(settled(5), 0u);
  EXPECT_EQ(settled(5, 30'000'000), 0u);
  EXPECT_EQ(count(FrameFault::kCameraInfoChanged), 2u) << "the info, and the image";
}

// Other drivers send an info now and then, with any stamp.
TEST_F(SensorsTest, WaitForNoCameraInfoWhereInfosDoNotComeWithImages) {
  make(kImage + kAbove);
  for (int i = 0; i < 20; ++i) {
    if (i % 3 == 0) {
      InfoText info;
      info.stamp_ns = kStart + i * kFrame - 5'000'000;
      add(Type::kCameraInfo, info.cdr(), info.stamp_ns);
    }
    add(flat(i, static_cast<std::uint16_t>(1000 + i)));
    EXPECT_EQ(settle(kStart + i * kFrame + 2000).size(), 1u) << i;
  }
}

TEST_F(SensorsTest, RefuseFramesThatComeMoreOftenThanTheCellStates) {
  make(kImage + kAbove + ", most_hz: 60");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add(flat(0, 1000));
  ImageText soon = flat(0, 1100);
  soon.stamp_ns += 10'000'000;
  add(soon);
  add(flat(1, 1200));
  EXPECT_EQ(count(FrameFault::kTooOften), 1u);
  EXPECT_EQ(settle(kStart + kFrame + 2000).size(), 1u);
}

TEST_F(SensorsTest, FindTheirPlaceByTheFrameOfTheMessageThroughLinksAndTheWorld) {
  make(kImage);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add(flat(0, 1000));
  add_joints(0.5, kStart);
  EXPECT_TRUE(settle(kStart + 30'000'000).empty());
  EXPECT_EQ(count(FrameFault::kNoPlace), 1u) << "no transform yet";
  const auto tf = test::transforms(kStart, kStart,
                                   {{"upper", "mast", {0.5, 0, 0}}, {"mast", "camera", {0, 0, 3}}});
  add(Type::kStaticTransforms, tf.cdr, kStart);
  add(flat(1, 1100));
  add_joints(0.5, kStart + kFrame);
  const auto frames = settle(kStart + kFrame + 1000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_LT(
      (frames[0].world_from_sensor.position - Vec3(0.5 * std::cos(0.5), 0.5 * std::sin(0.5), 3.0))
          .norm(),
      1e-9);
  EXPECT_LT(frames[0].pose_error, 1e-9) << "the stamp is that of the joints";
}

TEST_F(SensorsTest, RefuseAFrameWhoseTransformsLeadToNoPlaceOfTheCell) {
  make(kImage, "ros2: {world_frame: map}\n");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add(Type::kStaticTransforms, test::transforms(kStart, kStart, {{"odom", "camera"}}).cdr, kStart);
  add(flat(0, 1000));
  EXPECT_TRUE(settle(kStart + 30'000'000).empty());
  EXPECT_EQ(count(FrameFault::kNoPlace), 1u);
  // A late transform, and one that circles.
  add(Type::kTransforms, test::transforms(kStart, kStart + kFrame, {{"map", "odom"}}).cdr,
      kStart + kFrame);
  add(flat(1, 1100));
  EXPECT_EQ(settle(kStart + kFrame + 30'000'000).size(), 1u);
  add(Type::kTransforms, test::transforms(kStart, kStart + kFrame, {{"camera", "odom"}}).cdr,
      kStart + kFrame);
  add(flat(2, 1200));
  EXPECT_TRUE(settle(kStart + 2 * kFrame + 30'000'000).empty());
  EXPECT_EQ(count(FrameFault::kNoPlace), 2u);
}

// The lower arm is 0.8 to 1 m long along x of the shoulder, and 0.1 m thick: the camera sees its
// upper face 1.95 m below.
TEST_F(SensorsTest, LeaveOutTheRobotWhereItWasAtTheStampAndNotWhereItIsNow) {
  make("depth_image: /cam/image, size: [8, 6], depth_error: {constant: 0.01}, range: [0.3, 4]" +
       std::string(", mount: {pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, 0]}}"));
  InfoText narrow;  // all pixels look at the upper arm if it lies along x
  narrow.k = {400, 0, 3.5, 0, 400, 2.5, 0, 0, 1};
  narrow.p = {400, 0, 3.5, 0, 0, 400, 2.5, 0, 0, 0, 1, 0};
  add(Type::kCameraInfo, narrow.cdr(), kStart);
  add_joints(0.0, kStart);
  add_joints(2.0, kStart + 1'000'000'000);  // it has turned away since
  add(Type::kImage, flat(0, 1950).cdr(), kStart + 1'000'000'000);
  EXPECT_TRUE(settle(kStart + 1'000'000'000).empty());
  EXPECT_EQ(count(FrameFault::kNothingSeen), 1u);
  const auto own = sensors->status(0).own;
  EXPECT_EQ(std::ranges::max(own, {}, &OwnImageStatus::elements).elements, 48u);
  EXPECT_GT(std::ranges::max(own, {}, &OwnImageStatus::elements).thickness, 0.01);
  // Seen when it has turned away, the same picture is that of something else.
  ImageText later = flat(0, 1950);
  later.stamp_ns = kStart + 1'000'000'000;
  later.data[0] ^= 1;
  add(later);
  const auto frames = settle(kStart + 1'000'000'000);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].cloud->size(), 48u);
}

// The arm turns at 2 rad/s, and the picture was made 100 ms after its stamp: the arm is along x in
// it, and 0.2 rad off x at the stamp.
TEST_F(SensorsTest, LeaveOutTheRobotWithinTheStatedErrorOfTheStamp) {
  for (const bool is_stated : {false, true}) {
    SCOPED_TRACE(is_stated);
    make("depth_image: /cam/image, size: [8, 6], depth_error: {constant: 0.01}, range: [0.3, 4]" +
         std::string(is_stated ? ", stamp_error_ms: 100" : "") +
         ", mount: {pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, 0]}}");
    InfoText narrow;
    narrow.k = {400, 0, 3.5, 0, 400, 2.5, 0, 0, 1};
    narrow.p = {400, 0, 3.5, 0, 0, 400, 2.5, 0, 0, 0, 1, 0};
    add(Type::kCameraInfo, narrow.cdr(), kStart);
    for (int ms = -20; ms <= 120; ms += 10)
      add_joints(0.2 - 0.002 * ms, kStart + std::int64_t{ms} * 1'000'000);
    add(Type::kImage, flat(0, 1950).cdr(), kStart + 120'000'000);
    const auto frames = settle(kStart + 200'000'000);
    EXPECT_EQ(frames.size(), is_stated ? 0u : 1u);
    EXPECT_EQ(count(FrameFault::kNothingSeen), is_stated ? 1u : 0u);
    const auto own = sensors->status(0).own;
    const double thickness = std::ranges::max(own, {}, &OwnImageStatus::thickness).thickness;
    EXPECT_GT(thickness, is_stated ? 0.1 : -1.0);
  }
}

TEST_F(SensorsTest, CountTheUnknownMotionBetweenJointsAsAnErrorOfTheRobotsImage) {
  make(kImage + ", mount: {on: upper, pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, 0]}}");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add_joints(0.0, kStart - 5'000'000);
  add_joints(0.0, kStart + 5'000'000);
  add(flat(0, 1000));
  const auto frames = settle(kStart + 10'000'000);
  ASSERT_EQ(frames.size(), 1u);
  // At 2 rad/s for 5 ms, at the far end of the view of 8.1 m.
  EXPECT_NEAR(frames[0].pose_error, 0.01 * cell.scene.sensors[0].extent(), 0.03);
}

TEST_F(SensorsTest, WaitForJointsUpToTheStampButNotForLong) {
  make(kImage + kAbove);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add_joints(0.0, kStart - 1'000'000);
  add(flat(0, 1000));
  EXPECT_TRUE(settle(kStart + 2000).empty());
  EXPECT_TRUE(sensors->any_waiting());
  EXPECT_EQ(settle(kStart + 21'000'000).size(), 1u);
  add(flat(1, 1100));
  EXPECT_TRUE(settle(kStart + kFrame + 2000).empty());
  add_joints(0.0, kStart + kFrame);
  EXPECT_EQ(settle(kStart + kFrame + 3000).size(), 1u);
}

TEST_F(SensorsTest, RefuseFramesFromBeforeTheFirstJoints) {
  make(kImage + kAbove);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add(flat(0, 1000));
  add_joints(0.0, kStart + 1'000'000);
  EXPECT_TRUE(settle(kStart + 30'000'000).empty());
  EXPECT_EQ(count(FrameFault::kBeforeJoints), 1u);
  add(flat(1, 1100));
  add_joints(0.0, kStart + kFrame);
  EXPECT_EQ(settle(kStart + kFrame + 1000).size(), 1u);
}

TEST_F(SensorsTest, UseOnlyTheNewestOfSeveralFramesThatAreReady) {
  make(kImage + kAbove);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  for (int i = 0; i < 10; ++i) add(flat(i, static_cast<std::uint16_t>(1000 + i)));
  const auto frames = settle(kStart + 10 * kFrame);
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].stamp_ns, kStart + 9 * kFrame);
  EXPECT_EQ(sensors->status(0).skipped, 9u);
}

TEST_F(SensorsTest, RefuseFrozenDamagedAndForeignFramesByCause) {
  make(kImage + kAbove);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add(flat(0, 1000));
  EXPECT_EQ(settle(kStart + 1000).size(), 1u);
  const auto refuses = [&](const ImageText& image, FrameFault fault, std::uint64_t writer = 1) {
    const std::uint64_t before = count(fault);
    add(Type::kImage, image.cdr(), image.stamp_ns + 1000, writer);
    EXPECT_TRUE(settle(image.stamp_ns + 1000).empty());
    EXPECT_EQ(count(fault), before + 1) << text(fault);
  };
  refuses(flat(1, 1000), FrameFault::kFrozen);
  refuses(flat(1, 1001), FrameFault::kSecondPublisher, 2);
  ImageText half = flat(1, 1002);
  half.data.resize(40);
  refuses(half, FrameFault::kShortData);
  ImageText other = flat(1, 1003);
  other.encoding = "rgb8";
  refuses(other, FrameFault::kEncoding);
  refuses(flat(1, 0), FrameFault::kNothingSeen);
  refuses(flat(2, 9000), FrameFault::kNothingSeen);
  std::vector<std::byte> cut = flat(3, 1004).cdr();
  cut.resize(30);
  add(Type::kImage, cut, kStart);
  EXPECT_EQ(count(FrameFault::kUndecodable), 1u);
}

// The side rays go through the outer edges of the picture. Their tangent is at most 1.2374, as the
// lower bounds of slabs need it.
TEST_F(SensorsTest, RefuseImagesOfACameraWhoseSideRaysAreTooWide) {
  struct Case {
    double fx, fy, cx, cy;
    bool is_used;
    const char* of;
  };
  for (const Case& each :
       {Case{3.24, 10, 3.5, 2.5, true, "1.2346 to both sides"},
        Case{3.23, 10, 3.5, 2.5, false, "1.2384 to both sides"},
        Case{10, 2.43, 3.5, 2.5, true, "1.2346 up and down"},
        Case{10, 2.42, 3.5, 2.5, false, "1.2397 up and down"},
        Case{4.0, 10, 4.6, 2.5, false, "1.275 to the left"},
        Case{4.0, 10, 2.4, 2.5, false, "1.275 to the right"},
        Case{10, 3.0, 3.5, 3.3, false, "1.267 up"}, Case{10, 3.0, 3.5, 1.7, false, "1.267 down"},
        Case{4.0, 3.0, 4.0, 3.0, true, "1.125 to the left, 1.167 up"}}) {
    make(kImage + kAbove);
    InfoText info;
    info.k = {each.fx, 0, each.cx, 0, each.fy, each.cy, 0, 0, 1};
    info.p = {each.fx, 0, each.cx, 0, 0, each.fy, each.cy, 0, 0, 0, 1, 0};
    add(Type::kCameraInfo, info.cdr(), kStart);
    add(flat(0, 1000));
    EXPECT_EQ(settle(kStart + 2000).size(), each.is_used ? 1u : 0u) << each.of;
    EXPECT_EQ(count(FrameFault::kCannotBuild), each.is_used ? 0u : 1u) << each.of;
    EXPECT_EQ(count(FrameFault::kIntrinsics), 0u) << "it is a pinhole camera: " << each.of;
  }
}

TEST_F(SensorsTest, RefusePointsOfWhichAMessageHasMoreThanTheCellStates) {
  make(kPoints + ", most_points: 5" + kAbove);
  const auto take = [&](int number, std::uint32_t height, std::uint32_t width) {
    CloudText cloud;
    cloud.stamp_ns += number * kFrame;
    cloud.height = height;
    cloud.width = width;
    cloud.row_step = 20 * width;
    const std::array<float, 3> point = {0.1F, 0.2F, 1.0F + 0.1F * static_cast<float>(number)};
    cloud.data.assign(std::size_t{20} * width * height, 0);
    for (std::size_t i = 0; i < cloud.data.size(); i += 20)
      std::memcpy(&cloud.data[i], point.data(), sizeof point);
    add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
    return settle(cloud.stamp_ns + 1000);
  };
  const auto first = take(0, 1, 5);
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].cloud->size(), 5u) << "as many as it states";
  EXPECT_TRUE(take(1, 1, 6).empty());
  EXPECT_EQ(count(FrameFault::kTooManyPixels), 1u);
  EXPECT_TRUE(take(2, 2, 3).empty()) << "an organised cloud counts with all its rows";
  EXPECT_EQ(count(FrameFault::kTooManyPixels), 2u);
  EXPECT_EQ(sensors->status(0).stamp_ns, kStart) << "the frame before them stays in use";
  EXPECT_EQ(take(3, 1, 4).size(), 1u);
  EXPECT_EQ(count(FrameFault::kTooManyPixels), 2u);
}

TEST_F(SensorsTest, MakeBallsOfPointsThatContainErrorAndSpacing) {
  make(kPoints + ", spacing: 0.02" + kAbove);
  CloudText cloud;
  cloud.width = 3;
  cloud.row_step = 60;
  cloud.data.assign(60, 0);
  const auto put = [&](std::size_t point, float x, float y, float z) {
    const std::array<float, 3> values = {x, y, z};
    std::memcpy(&cloud.data[point * 20], values.data(), sizeof values);
  };
  put(0, 0.3F, 0.0F, 1.0F);
  put(1, 0.0F, 0.0F, std::numeric_limits<float>::quiet_NaN());
  put(2, 0.0F, 0.0F, 5.0F);  // out of range
  add(Type::kPoints, cloud.cdr(), kStart);
  const auto frames = settle(kStart + 1000);
  ASSERT_EQ(frames.size(), 1u);
  ASSERT_EQ(frames[0].cloud->size(), 1u);
  const double radius = frames[0].cloud->points()->block(0).radius[0];
  const double exact = 0.01 * std::hypot(0.3, 1.0) + 1.01 * 0.02 * std::sqrt(0.5);
  EXPECT_GE(radius, exact);
  EXPECT_LT(radius, exact * 1.0001);
}

// A point far to the side of a camera that looks along z: a person there is not left out.
TEST_F(SensorsTest, RefuseAPictureWithPointsThatAreTooFarToTheSide) {
  const auto take = [&](int number, float x, float z, const char* depth = "") {
    make(std::string(kPoints) + ", spacing: 0.02" + depth + kAbove);
    CloudText cloud;
    cloud.stamp_ns += number * 100'000'000;
    for (std::size_t i = 0; i < cloud.data.size(); i += 20) {
      const std::array<float, 3> point = {i == 0 ? x : 0.1F, 0.0F, i == 0 ? z : 1.0F};
      std::memcpy(&cloud.data[i], point.data(), sizeof point);
    }
    add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
    return settle(cloud.stamp_ns + 1000).size();
  };
  EXPECT_EQ(take(0, 1.7F, 1.0F), 1u);  // 59.5 degrees
  EXPECT_EQ(take(1, 1.8F, 1.0F), 0u);  // 60.9 degrees
  EXPECT_EQ(count(FrameFault::kCannotBuild), 1u);
  EXPECT_EQ(take(2, 1.0F, -0.1F), 0u);
  EXPECT_EQ(take(3, 0.0F, 0.0F), 1u) << "a driver's mark for a missing point";
  EXPECT_EQ(take(4, 1.0F, -0.1F, ", depth_along: ray"), 1u);
}

}  // namespace
}  // namespace clearance::sensors_test
