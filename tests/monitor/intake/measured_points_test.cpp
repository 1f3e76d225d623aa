// The balls of points of a message.
#include "monitor/intake/measured_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace clearance {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

FrameFault taken(const std::array<float, 6>& numbers, std::vector<MeasuredPoint>& points) {
  Sensor sensor;
  sensor.least_depth = 0.25;
  sensor.greatest_depth = 4.0;
  sensor.error_constant = 0.01;
  const PointsView view{.width = 2,
                        .height = 1,
                        .point_step = 12,
                        .row_step = 24,
                        .x = 0,
                        .y = 4,
                        .z = 8,
                        .bytes = std::as_bytes(std::span(numbers))};
  return measured_points(view, sensor, points);
}

// REP 117: -infinity is something nearer than can be measured, and infinity nothing. A LaserScan
// and a depth image have rays that say where; a point has none.
TEST(MeasuredPoints, OfMinusInfinityAreRefusedAndThoseOfInfinityAreMissing) {
  std::vector<MeasuredPoint> points;
  EXPECT_EQ(taken({0, 0, 1, 0, 0, -kInf}, points), FrameFault::kTooNear);
  EXPECT_EQ(taken({-kInf, -kInf, -kInf, 0, 0, 1}, points), FrameFault::kTooNear);
  ASSERT_EQ(taken({kInf, kInf, kInf, 0, 0, 1}, points), FrameFault::kNoFault);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_TRUE(std::isnan(points[0].x));
  EXPECT_GE(points[1].radius, 0.01F);
}

// Three points of a sweep; the last is missing. `time` has the type that is stated.
template <class Time>
FrameFault swept(PointsView::Times times, const std::array<Time, 3>& sent, double within_s) {
  struct Point {
    float x, y, z;
    Time time;
  };
  std::array<Point, 3> points{{{0, 0, 1, sent[0]}, {0, 0, 1, sent[1]}, {0, 0, 9, sent[2]}}};
  Sensor sensor;
  sensor.least_depth = 0.25;
  sensor.greatest_depth = 4.0;
  sensor.stamp_error_ns = static_cast<std::int64_t>(1e9 * within_s);
  const PointsView view{.width = 3,
                        .height = 1,
                        .point_step = sizeof(Point),
                        .row_step = sizeof points,
                        .x = offsetof(Point, x),
                        .y = offsetof(Point, y),
                        .z = offsetof(Point, z),
                        .time = offsetof(Point, time),
                        .times = times,
                        .bytes = std::as_bytes(std::span(points))};
  std::vector<MeasuredPoint> out;
  return measured_points(view, sensor, out);
}

TEST(MeasuredPoints, MeasuredOverMoreTimeThanTheStampIsOffAreRefused) {
  using enum PointsView::Times;
  constexpr auto kGood = FrameFault::kNoFault, kLong = FrameFault::kLongScan;
  // ns from the stamp.
  EXPECT_EQ(swept<std::uint32_t>(kUint32, {0, 100'000'000, 0}, 0.11), kGood);
  EXPECT_EQ(swept<std::uint32_t>(kUint32, {0, 100'000'000, 0}, 0.09), kLong);
  EXPECT_EQ(swept<std::uint32_t>(kUint32, {90'000'000, 100'000'000, 0}, 0.09), kLong);
  EXPECT_EQ(swept<std::uint32_t>(kUint32, {0, 0, 100'000'000}, 0.0), kGood) << "it is missing";
  // s from the stamp, also before it.
  EXPECT_EQ(swept<float>(kFloat32, {-0.1F, 0.0F, 0.0F}, 0.11), kGood);
  EXPECT_EQ(swept<float>(kFloat32, {-0.1F, -0.09F, 0.0F}, 0.09), kLong);
  EXPECT_EQ(swept<float>(kFloat32, {NAN, 0.0F, 0.0F}, 0.11), kLong) << "it may be any time";
  EXPECT_EQ(swept<float>(kFloat32, {0.0F, NAN, 0.0F}, 0.11), kLong);
  EXPECT_EQ(swept<float>(kFloat32, {1.7e9F, 1.7e9F, 0.0F}, 0.11), kLong) << "too coarse";
  // s or ns since an epoch.
  EXPECT_EQ(swept<double>(kFloat64, {1.7e9, 1.7e9 + 0.1, 0.0}, 0.11), kGood);
  EXPECT_EQ(swept<double>(kFloat64, {1.7e9, 1.7e9 + 0.1, 0.0}, 0.09), kLong);
  EXPECT_EQ(swept<double>(kFloat64, {1.7e18, 1.7e18 + 1e8, 0.0}, 0.11), kGood);
  EXPECT_EQ(swept<double>(kFloat64, {1.7e18, 1.7e18 + 1e8, 0.0}, 0.09), kLong);
  EXPECT_EQ(swept<std::uint32_t>(kNotSent, {0, 100'000'000, 0}, 0.0), kGood);
}

}  // namespace
}  // namespace clearance
