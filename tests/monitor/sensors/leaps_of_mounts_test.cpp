// Frames of cameras that leap in tf: by their transforms, by another parent, by a second publisher.
// They are used when they can have got there. Oracles: the motions that the test makes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "tests/monitor/sensors/mounted_camera.hpp"

namespace clearance::sensors_test {
namespace {

// What a mount states, and the speed that counts, m/s.
struct StatedSpeed {
  const char* mount;
  double speed;
};
constexpr StatedSpeed kSpeeds[] = {{"frame: mast, max_speed: 0.5, max_turn_speed: 0.1", 0.5},
                                   {"frame: mast", 5.0}};
// The largest timing error is the sensor's age limit.
constexpr int kAgeMs = 100;

class LeapsOfMounts : public MountedCamera {
 protected:
  // The mast is at `x` by this parent in each transform from one time to another, ms. An image
  // comes with every fifth one.
  void send(int from_ms, int to_ms, const char* parent, double x) {
    if (from_ms == 0) places_.clear();
    for (int ms = from_ms; ms < to_ms; ms += 20) {
      add_frame(parent, "mast", x, kStart + ms * kMs, kStart + ms * kMs);
      if (ms % 100 != 0) continue;
      const int image_ms = ms - 10;
      const auto frames = see(kStart + image_ms * kMs, kMs, 10 * kMs);
      if (!frames.empty()) places_[image_ms] = frames[0];
    }
  }
  // The images from one time to another have this place, and an error of at least this; or none.
  void expect(int from_ms, int to_ms, std::optional<double> x, double error = 0.0) const {
    int images = 0;
    for (int ms = from_ms; ms <= to_ms; ++ms) {
      if ((ms + 10) % 100 != 0) continue;
      ++images;
      const auto found = places_.find(ms);
      ASSERT_EQ(found != places_.end(), x.has_value()) << "the image of " << ms << " ms";
      if (!x) continue;
      EXPECT_NEAR(found->second.world_from_sensor.position.x(), *x, 1e-9) << ms;
      EXPECT_GE(found->second.pose_error, error) << ms;
    }
    EXPECT_GT(images, 0);
  }

 private:
  std::map<int, SensorFrame> places_;  // by image, ms
};

// The lie of an object with another parent is found, and so is that of a camera's frame.
TEST_F(LeapsOfMounts, ByAnotherParentAreTakenWhenTheFrameCanHaveGotThere) {
  constexpr double kDistance = 3.1;
  for (const auto& [mount, speed] : kSpeeds) {
    SCOPED_TRACE(mount);
    make_with_info(mount);
    add_static("map", "other", kDistance, kStart);
    const int there_ms = 1000 + static_cast<int>(1e3 * kDistance / speed) - kAgeMs;
    send(0, 1000, "map", 0.0);
    send(1000, there_ms + 2500, "other", 0.0);
    expect(90, 850, 0.0);
    expect(990, there_ms - 20, std::nullopt);
    // Where no speed is stated, the error is the whole distance for a second.
    expect(there_ms + 120, there_ms + 900, kDistance, speed > 1.0 ? kDistance : 0.0);
    expect(there_ms + 1300, there_ms + 2400, kDistance);
  }
}

TEST_F(LeapsOfMounts, AreTakenWhenTheFrameCanHaveGotThereAtItsSpeedAndNotAfterASecond) {
  constexpr double kDistance = 3.2;
  for (const auto& [mount, speed] : kSpeeds) {
    SCOPED_TRACE(mount);
    make_with_info(mount);
    const int there_ms = 1000 + static_cast<int>(1e3 * kDistance / speed) - kAgeMs;
    send(0, 1000, "map", 0.0);
    send(1000, there_ms + 2500, "map", kDistance);
    expect(990, there_ms - 20, std::nullopt);
    expect(there_ms + 1300, there_ms + 2400, kDistance);
  }
}

// Where no speed is stated, the frame may have turned back meanwhile.
TEST_F(LeapsOfMounts, ByATurnAreUncertainByItForASecond) {
  constexpr double kTurn = 0.5;  // rad, of a frame that may turn by 1 rad/s
  make_with_info("frame: mast");
  const auto send = [&](int from_ms, int to_ms, double turn) {
    double least = kInfinity;
    for (int ms = from_ms; ms < to_ms; ms += 20) {
      const std::int64_t at = kStart + ms * kMs;
      const test::FrameText mast{
          "map", "mast", {0, 0, 0}, {0, 0, std::sin(turn / 2), std::cos(turn / 2)}};
      add(Type::kTransforms, test::transforms(at, at, {mast}).cdr, at);
      if (ms % 100 != 0) continue;
      const auto frames = see(at - 10 * kMs, kMs, 10 * kMs);
      if (!frames.empty()) least = std::min(least, frames[0].pose_error);
    }
    return least;
  };
  const double before = send(0, 1000, 0.0);
  send(1000, 1200, kTurn);
  const double uncertain = send(1200, 1900, kTurn);
  EXPECT_LT(uncertain, kInfinity) << "it is used";
  EXPECT_GT(uncertain, before + kTurn * 0.3) << "at the least depth";
  EXPECT_NEAR(send(2200, 3000, kTurn), before, 1e-6);
}

// The frame is known again an age limit after the last wrong transform.
TEST_F(LeapsOfMounts, ThatEndKeepNoImageFromItsPlaceAnyLonger) {
  for (const auto& [mount, speed] : kSpeeds) {
    SCOPED_TRACE(mount);
    make_with_info(mount);
    send(0, 1000, "map", 0.0);
    send(1000, 1300, "map", 9.0);
    send(1300, 2500, "map", 0.0);
    expect(990, 1370, std::nullopt);
    expect(1390, 2400, 0.0);
  }
}

// As when a calibration is loaded into tf_static.
TEST_F(LeapsOfMounts, OfAStaticFrameAreJudgedAsWell) {
  make_with_info("frame: mast, max_speed: 0.5, max_turn_speed: 0.1");
  const auto x = [&](int ms) {
    const auto frames = see(kStart + ms * kMs);
    return frames.empty() ? -1.0 : frames[0].world_from_sensor.position.x();
  };
  add_static("map", "mast", 1.0, kStart);
  EXPECT_EQ(x(1000), 1.0);
  add_static("map", "mast", 4.2, kStart + 2000 * kMs);
  EXPECT_EQ(x(2100), -1.0);
  EXPECT_EQ(x(7000), -1.0);
  EXPECT_EQ(x(8500), 4.2) << "3.2 m, since it was known to be elsewhere at 1 s";
}

TEST_F(LeapsOfMounts, OfOnePublisherOfTwoLeaveTheFrameUnknown) {
  make_with_info("frame: mast");
  const auto both = [&](int from_ms, int to_ms, std::optional<double> second) {
    std::size_t frames = 0;
    for (int ms = from_ms; ms < to_ms; ms += 20) {
      const std::int64_t at = kStart + ms * kMs;
      add_frame("map", "mast", 0.0, at, at, 1);
      if (second) add_frame("map", "mast", *second, at + kMs, at + kMs, 2);
      if (ms % 100 == 0) frames += see(at - 10 * kMs, kMs, 12 * kMs).size();
    }
    return frames;
  };
  EXPECT_EQ(both(80, 1000, 0.0), 9u) << "both say the same";
  EXPECT_EQ(both(1000, 1500, 0.01), 0u);
  EXPECT_EQ(both(1500, 2400, {}), 0u) << "either may be right";
  EXPECT_EQ(both(2600, 3000, {}), 4u) << "the second one is silent";
  add_static("map", "mast", 0.01, kStart + 3000 * kMs, 3);
  EXPECT_EQ(both(3100, 5000, {}), 0u) << "a static transform holds for good";
  sensors->keep(std::vector<std::uint64_t>{1, 2});
  EXPECT_EQ(both(5000, 5900, {}), 0u);
  EXPECT_EQ(both(6100, 6500, {}), 4u) << "its publisher has left";
}

}  // namespace
}  // namespace clearance::sensors_test
