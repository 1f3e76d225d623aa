// Pictures that stopped, and pictures that are torn.
//
// Oracle: what the test did to the picture: which pixels go on, and how many are there.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

constexpr std::uint32_t kColumns = 64, kRows = 48, kPixels = kColumns * kRows;
const std::string kLarge =
    "depth_image: /cam/image, size: [64, 48], depth_error: {constant: 0.01}, range: [0.3, 4]";

class LivePictures : public SensorsTest {
 protected:
  void begin(const std::string& more, const std::string& mount = kAbove) {
    make(kLarge + more + mount);
    add_joints(0.0, kStart - 100'000'000);
    add_joints(0.0, kStart);
    InfoText info;
    info.width = kColumns, info.height = kRows;
    info.k = {60, 0, 31.5, 0, 60, 23.5, 0, 0, 1};
    info.p = {60, 0, 31.5, 0, 0, 60, 23.5, 0, 0, 0, 1, 0};
    add(Type::kCameraInfo, info.cdr(), kStart);
    number_ = 0;
  }
  // A wall at 1.5 m with noise of this standard deviation, mm.
  ImageText wall(double noise) {
    ImageText text;
    text.width = kColumns, text.height = kRows, text.step = 2 * kColumns;
    text.data.resize(2 * std::size_t{kPixels});
    for (std::size_t i = 0; i < kPixels; ++i) {
      double sum = -6.0;  // of twelve numbers: nearly normal
      for (int k = 0; k < 12; ++k) sum += random_.uniform(0.0, 1.0);
      put(text, i, static_cast<std::uint16_t>(std::lround(1500.3 + noise * sum)));
    }
    return text;
  }
  // True if it is used, as the next frame, while the shoulder is at this angle.
  bool uses(ImageText image, double shoulder = 0.0) {
    image.stamp_ns = kStart + ++number_ * kFrame;
    add_joints(shoulder, image.stamp_ns);
    add(image);
    return !settle(image.stamp_ns + 25'000'000).empty();
  }

  Random random_{7};
  std::int64_t number_ = 0;
};

TEST_F(LivePictures, WithTheNoiseOfACameraAreUsedAlsoOfAStillScene) {
  for (const double noise : {0.1, 0.3, 2.0}) {
    begin("");
    for (int i = 0; i < 60; ++i) EXPECT_TRUE(uses(wall(noise))) << noise << " " << i;
  }
}

TEST_F(LivePictures, ThatStandStillButForAFewPixelsAreFrozen) {
  for (const std::size_t changing : {std::size_t{0}, std::size_t{1}, std::size_t{kColumns / 2}}) {
    begin("");
    ImageText image = wall(1.0);
    ASSERT_TRUE(uses(image));
    for (int i = 1; i < 10; ++i) {
      for (std::size_t pixel = 0; pixel < changing; ++pixel)
        put(image, pixel * 7, static_cast<std::uint16_t>(1500 + 10 * i));
      EXPECT_FALSE(uses(image)) << changing << " " << i;
    }
    EXPECT_EQ(count(FrameFault::kFrozen), 9u);
    EXPECT_TRUE(uses(wall(1.0))) << "it goes on";
  }
}

TEST_F(LivePictures, OfARingOfTwelveBuffersAreFrozenFromItsSecondTurnOn) {
  begin("");
  std::vector<ImageText> ring;
  for (int i = 0; i < 12; ++i) ring.push_back(wall(1.0));
  for (int turn = 0; turn < 3; ++turn)
    for (const ImageText& buffer : ring) EXPECT_EQ(uses(buffer), turn == 0);
}

// A simulation of a still scene.
TEST_F(LivePictures, WithoutNoiseMayRepeatIfTheCellSaysSo) {
  begin(", noise: none");
  const ImageText image = wall(0.0);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(uses(image));
  EXPECT_EQ(count(FrameFault::kFrozen), 0u);
}

// The upper arm lies along x below the camera, before a floor.
TEST_F(LivePictures, WithoutNoiseAreFrozenIfTheRobotHasLeftItsImageInThem) {
  begin(", noise: none, own_shell: 0.03",
        ", mount: {pose: {xyz: [0.5, 0, 2], rpy: [3.141592653589793, 0, 0]}}");
  ImageText image = wall(0.0);
  for (std::uint32_t v = 0; v < kRows; ++v) {
    for (std::uint32_t u = 0; u < kColumns; ++u) {
      const double x = 1.95 * (u - 31.5) / 60.0, y = 1.95 * (v - 23.5) / 60.0;
      const bool is_arm = std::abs(x) < 0.38 && std::abs(y) < 0.04;
      put(image, v * std::size_t{kColumns} + u, is_arm ? 1950 : 3000);
    }
  }
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(uses(image)) << "it stands still";
  EXPECT_GT(sensors->status(0).own[1].elements, 40u) << "the upper arm";
  // As fast as the joint may turn, and back.
  for (int i = 1; i < 10; ++i) static_cast<void>(uses(image, 0.06 * i));
  EXPECT_FALSE(uses(image, 0.6)) << "it has turned, and its image has not";
  EXPECT_GT(count(FrameFault::kFrozen), 0u);
  for (int i = 9; i > 0; --i) static_cast<void>(uses(image, 0.06 * i));
  EXPECT_TRUE(uses(image, 0.0)) << "it is back";
}

TEST_F(LivePictures, ThatLoseAPartAtOnceAreTornUntilItIsBackOrTenSecondsHavePassed) {
  begin("");
  ASSERT_TRUE(uses(wall(1.0)));
  const auto torn = [&] {
    ImageText image = wall(1.0);
    for (std::size_t i = kPixels / 2; i < kPixels; ++i) put(image, i, 0);
    return image;
  };
  for (int i = 0; i < 290; ++i) ASSERT_FALSE(uses(torn())) << i;
  EXPECT_EQ(count(FrameFault::kSeenFell), 290u);
  EXPECT_TRUE(uses(wall(1.0)));
  for (int i = 0; i < 302; ++i) {
    const bool is_used = uses(torn());
    ASSERT_EQ(is_used, i + 1 >= 301) << i;
    if (is_used) break;
  }
  EXPECT_TRUE(uses(torn())) << "the scene is like that";
}

// A command changes the scene: the pictures before it are no other camera's.
TEST_F(LivePictures, AreComparedWithThoseBeforeTheCellChanged) {
  begin("");
  ASSERT_TRUE(uses(wall(1.0)));
  ImageText torn = wall(1.0);
  for (std::size_t i = kPixels / 2; i < kPixels; ++i) put(torn, i, 0);
  ASSERT_FALSE(uses(torn));
  const auto before = std::move(sensors);
  sensors = std::make_unique<Sensors>(cell, *before, SourceNumbers(cell.scene));
  ImageText next = wall(1.0);
  for (std::size_t i = kPixels / 2; i < kPixels; ++i) put(next, i, 0);
  EXPECT_FALSE(uses(next)) << "it is as torn as before";
  EXPECT_TRUE(uses(wall(1.0)));
}

// Fewer pixels from frame to frame, as when the camera turns towards the sky.
TEST_F(LivePictures, MayLoseTheirDepthSlowlyDownToTheStatedShare) {
  begin(", least_seen: 0.4");
  for (std::size_t there = kPixels; there > kPixels / 4; there -= kPixels / 20) {
    ImageText image = wall(1.0);
    for (std::size_t i = there; i < kPixels; ++i) put(image, i, 0);
    EXPECT_EQ(uses(image), 5 * there >= 2 * kPixels) << there;
  }
  EXPECT_GT(count(FrameFault::kFewSeen), 0u);
  EXPECT_EQ(count(FrameFault::kSeenFell), 0u);
}

}  // namespace
}  // namespace clearance::sensors_test
