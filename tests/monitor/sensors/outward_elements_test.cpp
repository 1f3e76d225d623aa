// Elements are rounded outward; both bounds hold the distance to what was measured all the same.
//
// Oracle: the distance of a ball from what the message says, in long double and without rounding:
// the slab of a pixel on the axis, a point's ball, and a leaf of a map.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/shapes.hpp"
#include "tests/monitor/sensors/small_camera.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/one_cube.hpp"
#include "tests/shared/random.hpp"

namespace clearance::sensors_test {
namespace {

using Long = long double;

class OutwardElements : public SensorsTest {
 protected:
  static constexpr double kRadius = 0.05;
  // A ball at the origin of the sensor's frame.
  static void expect_bounds(const SeenCloud& cloud, long double exact) {
    SlabBody body;
    CloudTracking tracking;
    const ConvexBody part = test::made(point(Vec3::Zero(), kRadius));
    const NearestElement found = cloud.nearest(part, RelativePose{}, body, tracking);
    EXPECT_LE(found.lower, exact);
    EXPECT_GE(found.upper, exact);
    EXPECT_LE(found.upper - found.lower, 3e-6);
  }
  void begin(const std::string& sensor) {
    make(sensor + kAbove);
    add_joints(0.0, kStart - 100'000'000);
    add_joints(0.0, kStart);
  }
};

TEST_F(OutwardElements, OfDepthImagesLeaveTheExactDistanceBetweenTheBounds) {
  for (int seed = 0; seed < 200; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    begin(kImage);
    InfoText info = narrow();
    info.k[2] = info.p[2] = 3.0, info.k[5] = info.p[6] = 2.0;  // the axis is within a pixel
    add(Type::kCameraInfo, info.cdr(), kStart);
    ImageText image = flat(0, 0);
    image.encoding = "32FC1", image.step = 32;
    image.data.assign(32 * 6, 0);
    const auto depth = static_cast<float>(random.uniform(0.5, 1.5));
    std::memcpy(image.data.data() + 2 * 32 + 3 * 4, &depth, sizeof depth);
    add(image);
    const auto frames = settle(kStart + 25'000'000);
    ASSERT_EQ(frames.size(), 1u);
    expect_bounds(*frames[0].cloud, Long{depth} - 0.01L - Long{kRadius});
  }
}

TEST_F(OutwardElements, OfPointsLeaveTheExactDistanceBetweenTheBounds) {
  for (int seed = 0; seed < 200; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    begin(kPoints);
    CloudText cloud;
    const float x = static_cast<float>(random.uniform(-0.5, 0.5));
    const float z = static_cast<float>(random.uniform(0.5, 1.5));
    cloud.data.assign(100, 0);
    std::memcpy(cloud.data.data(), &x, sizeof x);
    std::memcpy(cloud.data.data() + 8, &z, sizeof z);
    add(Type::kPoints, cloud.cdr(), kStart);
    const auto frames = settle(kStart + 25'000'000);
    ASSERT_EQ(frames.size(), 1u);
    const long double range = std::sqrt(Long{x} * x + Long{z} * z);
    expect_bounds(*frames[0].cloud, range - 0.01L * range / z - Long{kRadius});
  }
}

// A leaf far away is rounded by more than the near one, which is as large.
TEST_F(OutwardElements, OfMapsLeaveTheExactDistanceBetweenTheBounds) {
  for (unsigned near = 4; near < 30; ++near) {
    begin("octomap: /map, range: 10, age_limit_ms: 2000");
    const long double resolution = 0.1;
    std::string bytes = test::one_cube({near, 0, 0});
    test::RosCdr out;
    out.header(kStart, "camera").number(std::uint8_t{1}).text("OcTree").number(0.1);
    out.number(static_cast<std::uint32_t>(bytes.size()));
    for (const char byte : bytes) out.number(byte);
    sensors->add({.type = Type::kOctomap,
                  .topic = "/map",
                  .sent_ns = kStart,
                  .writer = 1,
                  .cdr = out.bytes()},
                 {.realtime_ns = kStart, .monotonic_ns = kStart});
    const auto frames = settle(kStart + 25'000'000);
    ASSERT_EQ(frames.size(), 1u);
    expect_bounds(*frames[0].cloud, (long double)near * resolution - Long{kRadius});
  }
}

}  // namespace
}  // namespace clearance::sensors_test
