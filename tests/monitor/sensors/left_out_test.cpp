// Elements that are left out of a frame: speckle that too few frames have, and what is beyond the
// reach of the links.
//
// Oracles: the pixels that the test puts in; the core's query of every single element that was
// there before.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/shapes.hpp"
#include "monitor/sensors/persistence.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

const std::string kPersist = ", max_speed: 0.5, persist: {frames: 2, of: 3}";

class LeftOutTest : public SensorsTest {
 protected:
  // The elements of the frame that is made of an image; 0: no frame.
  std::size_t elements(const ImageText& image) {
    add(image);
    const auto frames = settle(image.stamp_ns + 25'000'000);
    return frames.empty() ? 0 : frames[0].cloud->size();
  }
};

TEST_F(LeftOutTest, SpeckleIsHiddenUntilEnoughFramesHaveIt) {
  make(kImage + kPersist + kAbove);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  EXPECT_EQ(elements(flat(0, 1500)), 0u) << "one frame is not two of three";
  EXPECT_EQ(elements(flat(1, 1501)), 48u);
  ImageText speckled = flat(2, 1502);
  put(speckled, 20, 700);
  EXPECT_EQ(elements(speckled), 47u);
  EXPECT_EQ(sensors->status(0).hidden, 1u);
  // It is there again after one frame without it: two of three.
  EXPECT_EQ(elements(flat(3, 1503)), 48u);
  ImageText again = flat(4, 1504);
  put(again, 20, 701);
  EXPECT_EQ(elements(again), 48u);
  // After two frames without it, it is new.
  EXPECT_EQ(elements(flat(5, 1505)), 48u);
  EXPECT_EQ(elements(flat(6, 1506)), 48u);
  ImageText late = flat(7, 1507);
  put(late, 20, 702);
  EXPECT_EQ(elements(late), 47u);
}

TEST_F(LeftOutTest, ABodyThatMovesNoFasterThanStatedIsHiddenForItsFirstFrameOnly) {
  for (const bool is_too_fast : {false, true}) {
    make(kImage + kPersist + kAbove);
    add(Type::kCameraInfo, narrow().cdr(), kStart);
    static_cast<void>(elements(flat(0, 3500)));
    for (int i = 1; i < 8; ++i) {
      // 16 mm in a frame, and 0.45 m: more than cells and errors add to the speed.
      ImageText image = flat(i, static_cast<std::uint16_t>(3500 + i));
      put(image, 20, static_cast<std::uint16_t>(700 + i * (is_too_fast ? 250 : 16)));
      EXPECT_EQ(elements(image), i == 1 || is_too_fast ? 47u : 48u) << i;
    }
  }
}

TEST_F(LeftOutTest, TheConeOfAHiddenPixelIsUnseen) {
  make(kImage + kPersist + ", unseen: true" + kAbove);
  add(Type::kCameraInfo, InfoText{}.cdr(), kStart);
  add_joints(0.0, kStart);
  const auto unseen = [&](const ImageText& image) {
    add_joints(0.0, image.stamp_ns);
    static_cast<void>(elements(image));
    double least = kInfinity;
    for (const OwnImageStatus& link : sensors->status(0).own) least = std::min(least, link.unseen);
    return least;
  };
  static_cast<void>(unseen(flat(0, 3900)));
  const double before = unseen(flat(1, 3901));
  ImageText speckled = flat(2, 3902);
  for (std::size_t pixel = 0; pixel < 48; ++pixel) put(speckled, pixel, 700);
  EXPECT_LT(unseen(speckled), before - 0.1);
}

// A second after the last joint states each link may be metres from where it was.
TEST_F(LeftOutTest, LateJointsHideNothingThatIsFarFromWhereTheLinksWere) {
  make(kImage + kAbove);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(0.0, kStart);
  EXPECT_EQ(elements(flat(30, 1500)), 48u) << "half a metre above the arm";
  EXPECT_EQ(elements(flat(31, 1850)), 0u) << "0.15 m above it: the frame has nothing but the arm";
}

TEST_F(LeftOutTest, TheCellStatesHowThickTheShellOfALateLinkMayBe) {
  make(kImage + kAbove + ", own_shell: 0.02, most_shell: 0.1");
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(0.0, kStart);
  EXPECT_EQ(elements(flat(31, 1800)), 48u) << "0.15 m above the arm";
  EXPECT_LT(elements(flat(32, 1900)), 48u) << "some of it is less than 0.1 m from the arm";
}

// The joints are late, so the shell is as thick as the cell allows. The points are 0.06 of the
// depth apart, and so their balls reach 8 cm.
TEST_F(LeftOutTest, AnOrganisedPointBeyondTheThickestShellStaysHoweverFarItsBallReaches) {
  make(kPoints + ", spacing: neighbours, most_shell: 0.1" + kAbove);
  add_joints(0.0, kStart);
  const auto elements_at = [&](int number, float depth) {
    CloudText cloud;
    cloud.stamp_ns += number * kFrame;
    cloud.width = cloud.height = 4;
    cloud.row_step = 80;
    cloud.data.assign(320, 0);
    for (std::size_t i = 0; i < 16; ++i) {
      const std::array point = {0.06F * depth * (static_cast<float>(i % 4) - 1.5F),
                                0.06F * depth * (static_cast<float>(i / 4) - 1.5F), depth};
      std::memcpy(&cloud.data[20 * i], &point, sizeof point);
    }
    add(Type::kPoints, cloud.cdr(), cloud.stamp_ns);
    const auto frames = settle(cloud.stamp_ns + 25'000'000);
    return frames.empty() ? 0 : frames[0].cloud->size();
  };
  EXPECT_EQ(elements_at(31, 1.80F), 16u) << "0.15 m above the arm";
  EXPECT_LT(elements_at(32, 1.92F), 16u) << "some of it is less than 0.1 m from the arm";
}

// The clock of the camera was set back between two frames.
TEST(Persistence, TheTimeBetweenTwoFramesCountsWhicheverIsStampedLater) {
  Sensor sensor;
  sensor.persist_frames = 2;
  sensor.persist_of = 4;
  sensor.greatest_depth = 4.0;
  Persistence persistence(sensor, 1.5);
  const auto hidden_at = [&](float x, std::int64_t stamp_ms) {
    SeenCloud cloud = SeenCloud::of_points(1);
    const std::vector<MeasuredPoint> point = {{x, 0.0F, 0.0F, 0.01F}};
    EXPECT_EQ(cloud.points()->build(point, {Vec3::Zero(), 5.0}), CloudBuild::kBuilt);
    return persistence.hide(cloud, {}, 0.001, stamp_ms * 1'000'000, {}) > 0;
  };
  EXPECT_TRUE(hidden_at(1.0F, 1050)) << "the first frame";
  EXPECT_FALSE(hidden_at(1.07F, 1000)) << "1.5 m/s for 50 ms";
  EXPECT_TRUE(hidden_at(2.0F, 1050));
}

TEST(Persistence, NoElementIsHiddenThatEnoughFramesHaveWithinSpeedAndErrors) {
  Sensor sensor;
  sensor.persist_frames = 2;
  sensor.persist_of = 4;
  sensor.greatest_depth = 4.0;
  const double speed = 1.5;
  std::size_t hidden = 0, kept = 0;
  for (int seed = 0; seed < 30; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) * 31 + 7);
    Persistence persistence(sensor, speed);
    std::vector<std::vector<Vec3>> frames;  // in the world
    std::vector<std::int64_t> stamps;
    std::int64_t stamp = 1'000'000'000;
    for (int frame = 0; frame < 6; ++frame) {
      stamp += random.integer(1, 100) * 1'000'000;
      Pose place = random.pose(1.0);
      std::vector<MeasuredPoint> points;
      std::vector<Vec3> in_world;
      for (int i = 0; i < 200; ++i) {
        const Vec3 p = 2.0 * random.direction();
        points.push_back({static_cast<float>(p.x()), static_cast<float>(p.y()),
                          static_cast<float>(p.z()), 0.01F});
        in_world.push_back(place.orientation *
                               Vec3(points.back().x, points.back().y, points.back().z) +
                           place.position);
      }
      SeenCloud cloud = SeenCloud::of_points(1000);
      ASSERT_EQ(cloud.points()->build(points, {Vec3::Zero(), 5.0}), CloudBuild::kBuilt);
      std::vector<bool> stays(points.size());
      hidden += persistence.hide(cloud, place, 0.005, stamp, {});
      for (std::size_t b = 0; b < cloud.points()->blocks(); ++b) {
        const PointCloud::Block& block = cloud.points()->block(b);
        for (std::size_t lane = 0; lane < PointCloud::kFanOut; ++lane) {
          if (block.is_present(lane)) stays[block.source[lane]] = true;
        }
      }
      for (std::size_t i = 0; i < in_world.size(); ++i) {
        int found = 1;
        for (std::size_t k = frames.size() >= 3 ? frames.size() - 3 : 0; k < frames.size(); ++k) {
          const double apart = speed * 1e-9 * static_cast<double>(stamp - stamps[k]) + 0.01;
          const bool is_near = std::ranges::any_of(
              frames[k], [&](const Vec3& p) { return (p - in_world[i]).norm() <= apart; });
          found += is_near ? 1 : 0;
        }
        if (found < 2) continue;
        ++kept;
        EXPECT_TRUE(stays[i]) << seed << " " << frame << " " << i;
      }
      frames.push_back(in_world);
      stamps.push_back(stamp);
    }
  }
  EXPECT_GT(hidden, 500u);
  EXPECT_GT(kept, 1000u);
}

// The scara's links come to 2.25 m from its foot: two links of 1 m, and a finger that slides 0.2 m
// and has a radius of 0.05 m. Its foot is 1 m below.
TEST_F(LeftOutTest, ReachFollowsFromTheChainOfJointsAndTheMotionOfWhatIsSeen) {
  make(kImage + ", reach: 0.5, max_speed: 2" + kAbove);
  const Sensor& sensor = cell.scene.sensors[0];
  EXPECT_NEAR(sensor.crop.radius, 2.25 + 0.5 + 0.2, 0.01) << "with 2 m/s for 100 ms";
  EXPECT_FALSE(sensor.crop.is_carried);
  EXPECT_EQ(sensor.crop.centre, Vec3::Zero());
}

// A base that follows a frame is the second link: a floating joint leads to it.
TEST_F(LeftOutTest, ReachOfABaseThatFollowsAFrameIsAroundThatBase) {
  const test::ScratchFolder folder;
  test::write_text(folder / "scara.urdf", test::kScaraUrdf);
  cell = read_good(
      "name: test\nunits: {length: m, angle: rad}\nros2: {world_frame: map}\n"
      "robots: [{name: arm, urdf: scara.urdf, base: {frame: cart}}]\n"
      "sensors: [{name: eye, " +
          kImage + ", reach: 0.5" + kAbove + "}]\npairs: [{between: [arm, eye]}]\n",
      folder / "cell.yaml");
  const ReachBall& ball = cell.scene.sensors[0].crop;
  EXPECT_TRUE(ball.is_carried);
  EXPECT_EQ(ball.link, 1u);
  EXPECT_NEAR(ball.radius, 2.25 + 0.5, 0.01);
}

// An element beyond the reach is left out, but the distance is never said to be larger than that of
// what may be there.
TEST_F(LeftOutTest, BoundsHoldForWhatWasCropped) {
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

TEST_F(LeftOutTest, AFrameThatIsBeyondTheReachAsAWholeIsKept) {
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
TEST_F(LeftOutTest, PointsBeyondTheReachAreKeptIfOnlyTheRobotIsWithinIt) {
  make(kPoints + ", reach: 0" + kAbove);
  const auto elements_of = [&](int number, const std::vector<std::array<float, 3>>& points) {
    CloudText cloud;
    cloud.stamp_ns += number * kFrame;
    cloud.width = static_cast<std::uint32_t>(points.size());
    cloud.height = 1;
    cloud.row_step = 20 * cloud.width;
    cloud.data.assign(cloud.row_step, 0);
    for (std::size_t i = 0; i < points.size(); ++i)
      std::memcpy(&cloud.data[20 * i], &points[i], sizeof points[i]);
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
TEST_F(LeftOutTest, TheReachOfARobotOnAMovingBaseIsAroundThatBase) {
  struct Case {
    double base;  // its height, m
    std::size_t left;
  };
  for (const Case& each : {Case{0.0, 8}, Case{4.0, 48}, Case{7.0, 40}}) {
    const test::ScratchFolder folder;
    test::write_text(folder / "scara.urdf", test::kScaraUrdf);
    cell = read_good(
        "name: test\nunits: {length: m, angle: rad}\n"
        "objects: [{name: cart, sphere: {radius: 0.1}}]\n"
        "robots: [{name: arm, urdf: scara.urdf, base: {on: cart}}]\nsensors:\n  - {name: eye, " +
            kImage +
            ", reach: 0, own_shell: 0, mount: {pose: {xyz: [0, 0, 6], rpy: [3.14159, 0, 0]}}}\n"
            "pairs:\n  - {between: [arm, eye]}\n  - {between: [cart, eye]}\n",
        folder / "cell.yaml");
    ASSERT_TRUE(cell.scene.sensors[0].crop.is_carried);
    sensors = std::make_unique<Sensors>(cell, SensorsOptions{.is_log = false});
    std::uint32_t cart = 0;
    while (cell.scene.objects[cart].name != "cart") ++cart;
    ImageText image = flat(0, 1000);
    for (std::size_t pixel = 0; pixel < 8; ++pixel) put(image, pixel, 3999);
    for (int ms = -20; ms <= 20; ms += 10) {
      const std::int64_t stamp = image.stamp_ns + 1'000'000 * ms;
      sensors->add(std::vector{test::sample(cart, test::at(0, 0, each.base), stamp)},
                   test::joints(0.0, 0.0, 0.0, stamp), stamp);
    }
    add(Type::kCameraInfo, narrow().cdr(), kStart);
    EXPECT_EQ(elements(image), each.left) << each.base;
  }
}

}  // namespace
}  // namespace clearance::sensors_test
