// Oracle: the core's query of the part and a box that the exact factory makes, for every cube.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "monitor/clouds/own_points.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::cube_cloud_test {
namespace {

using test::made;

std::vector<ConvexBody> parts() {
  std::vector<ConvexBody> out;
  out.push_back(made(box({0.3, 0.1, 0.05})));
  out.push_back(made(segment({0, 0, -0.2}, {0, 0, 0.2}, 0.07)));
  out.push_back(made(point({0.1, 0, 0}, 0.2)));
  out.push_back(made(hard::facet_ball(4)));
  out.push_back(made(cylinder(0.1, 0.3)));
  out.push_back(made(ellipsoid({0.3, 0.2, 0.1})));
  return out;
}

// Leaves of several sizes on a grid, as an octomap has them, and a few that are not.
std::vector<MeasuredPoint> drawn(Random& random) {
  std::vector<MeasuredPoint> out;
  const float side = random.chance(0.5) ? 0.05F : 0.037F;
  for (int i = random.integer(1, 200); i > 0; --i) {
    const float half = 0.5F * side * static_cast<float>(1 << random.integer(0, 2));
    const auto at = [&] {
      return random.chance(0.9) ? half * static_cast<float>(2 * random.integer(-12, 12) + 1)
                                : static_cast<float>(random.uniform(-1, 1));
    };
    const float x = at(), y = at();
    out.push_back({x, y, at() + 1.0F, half});
  }
  return out;
}

RelativePose placed(const Pose& world_from_cloud, const Vec3& at) {
  Pose cube = world_from_cloud;
  cube.position += world_from_cloud.orientation * at;
  return relative_pose({}, cube);
}

// A cube of each size that is there, at the origin, by the exact factory.
class Cubes {
 public:
  const ConvexBody& of(float half) {
    auto found = made_.find(half);
    if (found == made_.end()) found = made_.emplace(half, made(box(Vec3::Constant(half)))).first;
    return found->second;
  }

 private:
  std::map<float, ConvexBody> made_;
};

TEST(CubeCloud, BoundsAreThoseOfBruteForceForEveryKindOfPart) {
  const std::vector<ConvexBody> all = parts();
  int contacts = 0;
  Cubes bodies;
  for (int seed = 0; seed < 40; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) * 977 + 1);
    const std::vector<MeasuredPoint> cubes = drawn(random);
    PointCloud cloud(cubes.size());
    ASSERT_EQ(cloud.build_cubes(cubes, {{0, 0, 1}, 5.0}), CloudBuild::kBuilt);
    for (const ConvexBody& part : all) {
      CloudTracking tracking;
      for (int query = 0; query < 3; ++query) {
        Pose place = random.pose(0.5);
        place.position -= place.orientation * Vec3(0, 0, 1);
        const NearestElement found =
            nearest_element(part, cloud, relative_pose({}, place), tracking);
        double lower = kInfinity, upper = kInfinity;
        for (const MeasuredPoint& cube : cubes) {
          TrackingState state;
          const ConvexBody& body = bodies.of(cube.radius);
          const DistanceResult r =
              distance(part, body, placed(place, Vec3(cube.x, cube.y, cube.z)), state);
          lower = std::min(lower, r.lower);
          upper = std::min(upper, r.upper);
        }
        ASSERT_EQ(found.answer, CloudAnswer::kNearest);
        EXPECT_LE(found.lower, upper) << seed;
        EXPECT_GE(found.upper, lower) << seed;
        EXPECT_LE(found.upper - found.lower, 1e-9) << seed;
        contacts += found.upper < 0.0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(contacts, 50);
}

TEST(CubeCloud, ExactlyTheCubesWithinTheShellAreShelved) {
  const ConvexBody part = made(box({0.2, 0.1, 0.15}));
  std::size_t shelved = 0;
  Cubes bodies;
  for (int seed = 0; seed < 60; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 77);
    const std::vector<MeasuredPoint> cubes = drawn(random);
    PointCloud cloud(cubes.size());
    ASSERT_EQ(cloud.build_cubes(cubes, {{0, 0, 1}, 5.0}), CloudBuild::kBuilt);
    Pose place = random.pose(0.3);
    place.position -= place.orientation * Vec3(0, 0, 1);
    const double shell = 0.03;
    const BlindShell blind = shelve_own_points(part, relative_pose({}, place), shell, cloud);
    shelved += blind.elements;
    for (std::size_t b = 0; b < cloud.blocks(); ++b) {
      for (std::size_t lane = 0; lane < PointCloud::kFanOut; ++lane) {
        const MeasuredPoint& cube = cubes[cloud.block(b).source[lane]];
        TrackingState state;
        const ConvexBody& body = bodies.of(cube.radius);
        const DistanceResult r =
            distance(part, body, placed(place, Vec3(cube.x, cube.y, cube.z)), state);
        if (std::abs(r.lower - shell) < 1e-9) continue;
        EXPECT_EQ(cloud.block(b).is_present(lane), r.lower > shell) << seed;
        if (r.lower > shell) continue;
        EXPECT_GE(blind.thickness, shell + 2.0 * std::sqrt(3.0) * cube.radius * (1 - 1e-12));
      }
    }
  }
  EXPECT_GT(shelved, 100u);
}

TEST(CubeCloud, HasNoMoreSizesThanItsMemory) {
  std::vector<MeasuredPoint> cubes;
  for (int i = 1; i <= static_cast<int>(PointCloud::kMostSizes); ++i)
    cubes.push_back({0, 0, 0, 0.01F * static_cast<float>(i)});
  PointCloud cloud(100);
  EXPECT_EQ(cloud.build_cubes(cubes, {Vec3::Zero(), 5.0}), CloudBuild::kBuilt);
  cubes.push_back({0, 0, 0, 0.7F});
  EXPECT_EQ(cloud.build_cubes(cubes, {Vec3::Zero(), 5.0}), CloudBuild::kBadRadius);
  EXPECT_EQ(cloud.size(), PointCloud::kMostSizes) << "the cloud before";
  cubes.back().radius = -1.0F;
  EXPECT_EQ(cloud.build_cubes(cubes, {Vec3::Zero(), 5.0}), CloudBuild::kBadRadius);
}

}  // namespace
}  // namespace clearance::cube_cloud_test
