// The balls of points of a message.
#include "monitor/intake/measured_points.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
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

}  // namespace
}  // namespace clearance
