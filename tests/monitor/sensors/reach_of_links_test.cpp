// Elements beyond the reach of the links are left out of a frame.
//
// Oracles: the pixels and points that the test puts in; the core's query of every single element
// that was there before.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>
#include <vector>

#include "core/shapes.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

class ReachOfLinks : public SensorsTest {
 protected:
  static CloudText cloud_of(const std::vector<std::array<float, 3>>& points, int number = 0) {
    CloudText cloud;
    cloud.stamp_ns += number * kFrame;
    cloud.width = static_cast<std::uint32_t>(points.size());
    cloud.height = 1;
    cloud.row_step = 20 * cloud.width;
    cloud.data.assign(cloud.row_step, 0);
    for (std::size_t i = 0; i < points.size(); ++i)
      std::memcpy(&cloud.data[20 * i], &points[i], sizeof points[i]);
    return cloud;
  }
  // Reads a cell whose robots are `scara.urdf`.
  void read_with_scara(const std::string& text) {
    const test::ScratchFolder folder;
    test::write_text(folder / "scara.urdf", test::kScaraUrdf);
    cell = read_good("name: test\nunits: {length: m, angle: rad}\n" + text, folder / "cell.yaml");
  }
  [[nodiscard]] std::uint32_t cart() const {
    std::uint32_t object = 0;
    while (cell.scene.objects[object].name != "cart") ++object;
    return object;
  }
};

// The scara's links come to 2.25 m from its foot: two links of 1 m, and a finger that slides 0.2 m
// and has a radius of 0.05 m. Its foot is 1 m below.
TEST_F(ReachOfLinks, ReachFollowsFromTheChainOfJointsAndTheMotionOfWhatIsSeen) {
  make(kImage + ", reach: 0.5, max_speed: 2" + kAbove);
  const Sensor& sensor = cell.scene.sensors[0];
  ASSERT_EQ(sensor.crop.size(), 1u);
  EXPECT_NEAR(sensor.crop[0].radius, 2.25 + 0.5 + 0.2, 0.01) << "with 2 m/s for 100 ms";
  EXPECT_FALSE(sensor.crop[0].is_carried);
  EXPECT_EQ(sensor.crop[0].centre, Vec3::Zero());
}

// A base that follows a frame is the second link: a floating joint leads to it.
TEST_F(ReachOfLinks, ReachOfABaseThatFollowsAFrameIsAroundThatBase) {
  read_with_scara(
      "ros2: {world_frame: map}\n"
      "robots: [{name: arm, urdf: scara.urdf, base: {frame: cart}}]\n"
      "sensors: [{name: eye, " +
      kImage + ", reach: 0.5" + kAbove + "}]\npairs: [{between: [arm, eye]}]\n");
  ASSERT_EQ(cell.scene.sensors[0].crop.size(), 1u);
  const ReachBall& ball = cell.scene.sensors[0].crop[0];
  EXPECT_TRUE(ball.is_carried);
  EXPECT_EQ(ball.link, 1u);
  EXPECT_NEAR(ball.radius, 2.25 + 0.5, 0.01);
}

// An element beyond the reach is left out, but the distance is never said to be larger than that of
// what may be there.
TEST_F(ReachOfLinks, BoundsHoldForWhatWasCropped) {
  std::size_t cropped = 0, limited = 0;
  for (const bool of_points : {false, true}) {
    for (int seed = 0; seed < 25; ++seed) {
      Random random(static_cast<std::uint64_t>(seed) * 101 + 3);
      const CloudCrop crop{.centre = Vec3(0, 0, 1) + 0.3 * random.direction(),
                           .radius = random.uniform(0.3, 0.8)};
      const PinholeCamera camera{16, 12, 15.0, 15.0, 7.5, 5.5};
      std::vector<float> depth(camera.width * camera.height);
      std::vector<MeasuredPoint> points;
      for (std::size_t i = 0; i < depth.size(); ++i) {
        depth[i] = static_cast<float>(random.uniform(0.4, 3.0));
        const Vec3 p = depth[i] * random.direction();
        points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z()), 0.02F});
      }
      SeenCloud whole = of_points ? SeenCloud::of_points(1000) : SeenCloud::of_images(16, 12);
      SeenCloud cloud = of_points ? SeenCloud::of_points(1000) : SeenCloud::of_images(16, 12);
      if (of_points) {
        ASSERT_EQ(whole.points()->build(points, {Vec3::Zero(), 9.0}), CloudBuild::kBuilt);
        ASSERT_EQ(cloud.points()->build(points, crop), CloudBuild::kBuilt);
      } else {
        const DepthImage image{DepthImage::Format::kMetres32, camera.width, camera.height,
                               camera.width * 4, std::as_bytes(std::span(depth))};
        ASSERT_EQ(whole.depth()->build(camera, image, {0.01, 0.0}, {0.3, 4.0}), DepthBuild::kBuilt);
        ASSERT_EQ(cloud.depth()->build(camera, image, {0.01, 0.0}, {0.3, 4.0}), DepthBuild::kBuilt);
        cloud.depth()->crop(crop.centre, crop.radius);
        cloud.refit();
      }
      if (cloud.size() == 0 || cloud.size() == whole.size()) continue;
      cropped += whole.size() - cloud.size();
      cloud.note_crop(crop);
      const ConvexBody part = test::made(box({0.2, 0.1, 0.15}));
      for (int query = 0; query < 20; ++query) {
        Pose place = random.pose(0.7);
        place.position += crop.centre;
        const RelativePose pose = relative_pose(place, {});
        SlabBody body;
        CloudTracking of_whole, of_cloud;
        const NearestElement exact = whole.nearest(part, pose, body, of_whole);
        const NearestElement found = cloud.nearest(part, pose, body, of_cloud);
        EXPECT_LE(found.lower, exact.upper);
        EXPECT_GE(found.upper, exact.lower);
        limited += found.lower < found.upper - 1e-6 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(cropped, 1000u);
  EXPECT_GT(limited, 50u);
}

TEST_F(ReachOfLinks, AFrameThatIsBeyondTheReachAsAWholeIsKept) {
  make(kImage + ", reach: 0, own_shell: 0, mount: {pose: {xyz: [0, 0, 6], rpy: [3.14159, 0, 0]}}");
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  EXPECT_EQ(elements(flat(0, 1000)), 48u);
  EXPECT_EQ(sensors->status(0).cropped, 0u);
  // One row comes near: the others are cropped.
  ImageText image = flat(1, 1000);
  for (std::size_t pixel = 0; pixel < 8; ++pixel) put(image, pixel, 3999);
  EXPECT_EQ(elements(image), 8u);
  EXPECT_EQ(sensors->status(0).cropped, 40u);
}

// The points beyond the reach are 2 m beside the arm and 2 m below it.
TEST_F(ReachOfLinks, PointsBeyondTheReachAreKeptIfOnlyTheRobotIsWithinIt) {
  make(kPoints + ", reach: 0" + kAbove);
  const auto elements_of = [&](int number, const std::vector<std::array<float, 3>>& points) {
    const CloudText cloud = cloud_of(points, number);
    add_joints(0.0, cloud.stamp_ns);
    add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
    const auto frames = settle(cloud.stamp_ns + 1000);
    return frames.empty() ? 0 : frames[0].cloud->size();
  };
  const std::array<float, 3> arm{0.5F, 0, 1.95F}, near{0.5F, 0.5F, 1.5F}, far{2, 0, 3.9F};
  EXPECT_EQ(elements_of(0, {arm, near, far, far}), 1u);
  EXPECT_EQ(sensors->status(0).cropped, 2u);
  EXPECT_EQ(elements_of(1, {arm, arm, far, far}), 2u);
  EXPECT_EQ(sensors->status(0).cropped, 0u);
  EXPECT_EQ(elements_of(2, {arm, arm}), 0u) << "nothing shows that the place is clear";
  EXPECT_EQ(count(FrameFault::kNothingSeen), 1u);
}

// The camera looks down from 6 m. One row of the picture is 2 m above the floor, the others 5 m.
TEST_F(ReachOfLinks, TheReachOfARobotOnAMovingBaseIsAroundThatBase) {
  struct Case {
    double base;  // its height, m
    std::size_t left;
  };
  for (const Case& each : {Case{0.0, 8}, Case{4.0, 48}, Case{7.0, 40}}) {
    read_with_scara(
        "objects: [{name: cart, sphere: {radius: 0.1}}]\n"
        "robots: [{name: arm, urdf: scara.urdf, base: {on: cart}}]\nsensors:\n  - {name: eye, " +
        kImage +
        ", reach: 0, own_shell: 0, mount: {pose: {xyz: [0, 0, 6], rpy: [3.14159, 0, 0]}}}\n"
        "pairs:\n  - {between: [arm, eye]}\n  - {between: [cart, eye]}\n");
    ASSERT_TRUE(cell.scene.sensors[0].crop.at(0).is_carried);
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{.is_log = false});
    ImageText image = flat(0, 1000);
    for (std::size_t pixel = 0; pixel < 8; ++pixel) put(image, pixel, 3999);
    for (int ms = -20; ms <= 20; ms += 10) {
      const std::int64_t stamp = image.stamp_ns + 1'000'000 * ms;
      sensors->add(std::vector{test::sample(cart(), test::at(0, 0, each.base), stamp)},
                   test::joints(0.0, 0.0, 0.0, stamp), stamp);
    }
    add(Type::kCameraInfo, narrow().cdr(), kStart);
    EXPECT_EQ(elements(image), each.left) << each.base;
  }
}

// One robot stands at the origin and another on a cart, 5 m beside it. What is between them, or
// near one of them, may be reached.
TEST_F(ReachOfLinks, TheReachOfRobotsOnSeveralBasesIsABallAroundThatOfEach) {
  for (const double cart_x : {5.0, -5.0}) {
    read_with_scara(
        "objects: [{name: cart, sphere: {radius: 0.1}}]\nrobots:\n"
        "  - {name: left, urdf: scara.urdf, prefix: left_}\n"
        "  - {name: right, urdf: scara.urdf, prefix: right_, base: {on: cart}}\nsensors:\n"
        "  - {name: eye, points: /cam/points, depth_error: {constant: 0.01}, range: [0.3, 9], "
        "depth_along: ray, reach: 0, own_shell: 0" +
        kAbove +
        "}\npairs: [{between: [left, eye]}, {between: [right, eye]}, {between: [cart, eye]}]\n");
    ASSERT_EQ(cell.scene.sensors[0].crop.size(), 2u);
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{.is_log = false});
    // At 1.5 m from each base, between them, and beyond either of them.
    const CloudText cloud =
        cloud_of({{5, 1.5F, 2}, {-5, 1.5F, 2}, {2.5F, 0, 2}, {-2.5F, 0, 2}, {0, 1.5F, 2}});
    for (int ms = -20; ms <= 20; ms += 10) {
      const std::int64_t stamp = cloud.stamp_ns + 1'000'000 * ms;
      sensors->add(std::vector{test::sample(cart(), test::at(cart_x, 0, 0), stamp)},
                   test::joints(0.0, 0.0, 0.0, stamp), stamp);
    }
    add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
    const auto frames = settle(cloud.stamp_ns + 1000);
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].cloud->size(), 3u);
    EXPECT_EQ(sensors->status(0).cropped, 2u);
    std::set<double> kept;  // a block repeats its last point
    frames[0].cloud->for_each(
        [&](std::size_t, std::size_t, const Vec3& at, double) { kept.insert(at.x()); });
    EXPECT_EQ(kept, std::set<double>({0.0, 0.5 * cart_x, cart_x}));
  }
}

}  // namespace
}  // namespace clearance::sensors_test
