// Oracle: every point compared with the hull.
#include "config/decomposition/open_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "config/decomposition/rough_hull.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

Vec3 random_point(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(OpenBlocks, FindTheFarthestPointInAHullAsOneByOne) {
  constexpr double kSpacing = 0.01;
  Random random(5);
  std::vector<OpenPoint> points;
  for (int i = 0; i < 4000; ++i) {
    points.push_back({random_point(random, 0.5), random.uniform(0.0, 0.1)});
  }
  const OpenBlocks blocks(points, kSpacing);
  int found = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3> corners;
    const Vec3 middle = random_point(random, 0.5);
    for (int k = 0; k < 10; ++k) corners.push_back(middle + random_point(random, 0.001 * i));
    const std::vector<HalfSpace> hull = rough_hull(corners);
    const double near = 0.5 * kSpacing;
    Eigen::AlignedBox3d box;
    for (const Vec3& corner : corners) box.extend(corner);
    const Eigen::AlignedBox3d wide(box.min().array() - near, box.max().array() + near);
    double most = 0.0;
    for (const OpenPoint& point : points) {
      if (!wide.contains(point.position) || !holds(hull, point.position, near)) continue;
      most = std::max(most, point.distance);
    }
    found += most > 0.0 ? 1 : 0;
    EXPECT_EQ(most, blocks.farthest_in(hull, wide, near)) << i;
  }
  EXPECT_GT(found, 50);
}

}  // namespace
}  // namespace clearance
