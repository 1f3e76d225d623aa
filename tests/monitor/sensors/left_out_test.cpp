// Elements that are left out of a frame: the robot's own image, and speckle that too few frames
// have.
//
// Oracle: the pixels that the test puts in.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "monitor/sensors/persistence.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

const std::string kPersist = ", max_speed: 0.5, persist: {frames: 2, of: 3}";

class LeftOutTest : public SensorsTest {};

TEST_F(LeftOutTest, SpeckleIsHiddenUntilEnoughFramesHaveIt) {
  make(kImage + kPersist + kAbove);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  EXPECT_EQ(elements(flat(0, 1500)), 0u) << "one frame is not two of three";
  EXPECT_EQ(elements(flat(1, 1501)), 48u);
  ImageText speckled = flat(2, 1502);
  put(speckled, 20, 700);
  EXPECT_EQ(elements(speckled), 47u);
  EXPECT_EQ(sensors->status(0).hidden, 1u);
  // The element is there again after one frame without it: two of three.
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

// Speckle behind the links counts, too: the frames before did not show that place.
TEST_F(LeftOutTest, TheConeOfAHiddenPixelIsUnseen) {
  make(kImage + kPersist + ", unseen: true" + kAbove);
  add(Type::kCameraInfo, narrow().cdr(), kStart);
  add_joints(0.0, kStart);
  int number = 0;
  const auto unseen = [&](int depth) {
    ++number;
    ImageText image = flat(number, static_cast<std::uint16_t>(3500 + number));
    for (std::size_t pixel = 0; depth > 0 && pixel < 48; ++pixel)
      put(image, pixel, static_cast<std::uint16_t>(depth));
    add_joints(0.0, image.stamp_ns);
    static_cast<void>(elements(image));
    double least = kInfinity;
    for (const OwnImageStatus& link : sensors->status(0).own) least = std::min(least, link.unseen);
    return least;
  };
  for (const int speckle : {700, 3900}) {
    for (int i = 0; i < 4; ++i) static_cast<void>(unseen(0));
    const double before = unseen(0);
    EXPECT_LT(unseen(speckle), before - 0.1) << speckle;
  }
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

// Both stamps may be off by 20 ms, so that the body had 50 ms.
TEST(Persistence, TheErrorsOfBothStampsCountAsTime) {
  for (const bool has_error : {false, true}) {
    Sensor sensor;
    sensor.persist_frames = 2;
    sensor.persist_of = 4;
    sensor.greatest_depth = 4.0;
    sensor.stamp_error_ns = has_error ? 20'000'000 : 0;
    Persistence persistence(sensor, 1.5);
    const auto is_hidden = [&](float x, std::int64_t stamp_ms) {
      SeenCloud cloud = SeenCloud::of_points(1);
      const std::vector<MeasuredPoint> point = {{x, 0.0F, 0.0F, 0.01F}};
      EXPECT_EQ(cloud.points()->build(point, {Vec3::Zero(), 5.0}), CloudBuild::kBuilt);
      return persistence.hide(cloud, {}, 0.001, stamp_ms * 1'000'000, {}) > 0;
    };
    EXPECT_TRUE(is_hidden(1.0F, 1000)) << "the first frame";
    EXPECT_EQ(is_hidden(1.07F, 1010), !has_error);
  }
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

}  // namespace
}  // namespace clearance::sensors_test
