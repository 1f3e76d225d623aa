// Oracle: the distance of the part and every element before shelving, one by one.
#include "monitor/clouds/own_points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "core/shapes.hpp"
#include "monitor/clouds/nearest_element.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::own_points_test {
namespace {

using test::made;

const PinholeCamera kCamera{40, 30, 40.0, 41.0, 19.7, 14.9};

// A depth image of noise between 0.5 and 1.5 m.
std::vector<float> noise(Random& random) {
  std::vector<float> depth(kCamera.width * kCamera.height);
  for (float& z : depth) z = static_cast<float>(random.uniform(0.5, 1.5));
  return depth;
}

DepthImage image_of(const std::vector<float>& depth) {
  return {DepthImage::Format::kMetres32, kCamera.width, kCamera.height, kCamera.width * 4,
          std::as_bytes(std::span(depth))};
}

// Every lane of a cloud: is it present?
std::vector<bool> present(const DepthCloud& cloud) {
  std::vector<bool> out;
  for (std::size_t b = 0; b < cloud.blocks(); ++b) {
    for (std::size_t lane = 0; lane < DepthCloud::kFanOut; ++lane) {
      out.push_back(!DepthCloud::is_empty(cloud.node(0, b)) &&
                    cloud.block(b).low[lane] <= cloud.block(b).high[lane]);
    }
  }
  return out;
}

TEST(OwnPoints, ExactlyTheSlabsWithinTheShellOfAPartAreShelved) {
  const ConvexBody part = made(box({0.2, 0.1, 0.15}));
  std::size_t shelved = 0;
  for (int seed = 0; seed < 20; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 1);
    const std::vector<float> depth = noise(random);
    DepthCloud cloud(kCamera.width, kCamera.height);
    ASSERT_EQ(cloud.build(kCamera, image_of(depth), {0.001, 0.0025}, {0.25, 4.0}),
              DepthBuild::kBuilt);
    Pose place = random.pose(0.3);
    place.position.z() += 1.0;
    const RelativePose pose = relative_pose(place, {});
    const double shell = seed % 2 == 0 ? 0.0 : 0.03;
    const DepthCloud before = cloud;
    SlabBody body;
    const BlindShell blind = shelve_own_points(part, pose, shell, cloud, body);
    const std::vector<bool> was = present(before), is = present(cloud);
    std::size_t gone = 0;
    for (std::size_t i = 0; i < was.size(); ++i) {
      if (!was[i]) continue;
      TrackingState state;
      const DepthCloud::Slab slab = before.pixel_slab(i / 8, i % 8);
      const DistanceResult r = distance(part, body.of(slab), pose, state);
      if (r.upper <= shell) {
        EXPECT_FALSE(is[i]) << seed << ", " << i;
      }
      if (r.lower > shell + 1e-12) {
        EXPECT_TRUE(is[i]) << seed << ", " << i;
      }
      if (is[i]) continue;
      ++gone;
      // The far end of the slab lies within the blind shell.
      for (const double z : {slab.low, slab.high}) {
        const ConvexBody vertex = made(point({slab.x1 * z, slab.y0 * z, z}, 0.0));
        TrackingState other;
        EXPECT_LE(distance(part, vertex, pose, other).lower, blind.thickness) << seed;
      }
    }
    EXPECT_EQ(gone, blind.elements);
    EXPECT_EQ(cloud.size(), before.size() - gone);
    shelved += gone;
  }
  EXPECT_GT(shelved, 200U);
}

TEST(OwnPoints, ExactlyTheBallsWithinTheShellOfAPartAreShelvedAndNoQueryMeetsThem) {
  const ConvexBody part = made(segment({0, 0, -0.2}, {0, 0, 0.2}, 0.07));
  Random random(7);
  std::vector<MeasuredPoint> points;
  for (int i = 0; i < 2003; ++i) {
    const Vec3 at = random.in_box(0.6);
    points.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()),
                      static_cast<float>(at.z()), 0.004F});
  }
  PointCloud cloud(points.size());
  ASSERT_EQ(cloud.build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
  const RelativePose pose = relative_pose(random.pose(0.2), {});
  const double shell = 0.05;
  const BlindShell blind = shelve_own_points(part, pose, shell, cloud);
  std::size_t near = 0;
  double nearest = kInfinity;
  for (const MeasuredPoint& p : points) {
    TrackingState state;
    const double d = distance(part, made(point({p.x, p.y, p.z}, p.radius)), pose, state).lower;
    near += d <= shell ? 1 : 0;
    if (d > shell) nearest = std::min(nearest, d);
  }
  EXPECT_GT(near, 20U);
  EXPECT_EQ(blind.elements, near);
  EXPECT_EQ(cloud.size(), points.size() - near);
  EXPECT_NEAR(blind.thickness, shell + 0.008, 1e-6);
  for (const bool refitted : {false, true}) {
    if (refitted) cloud.refit();
    CloudTracking tracking;
    EXPECT_NEAR(nearest_element(part, cloud, pose, tracking).lower, nearest, 1e-9) << refitted;
  }
}

// Balls reach up to 0.4 m, with an error of 1 cm. The oracle is the place of each point.
TEST(OwnPoints, NoPointBeyondTheLimitIsShelvedHoweverFarItsBallReachesAndThePartItselfIs) {
  const ConvexBody part = made(segment({0, 0, 1.8}, {0, 0, 2.2}, 0.07));
  const double error = 0.01, most = 0.1;
  for (const double shell : {0.0, 0.04, most}) {
    Random random(9);
    std::vector<MeasuredPoint> points;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 at = Vec3(0, 0, 2) + random.in_box(0.5);
      points.push_back({static_cast<float>(at.x()), static_cast<float>(at.y()),
                        static_cast<float>(at.z()), static_cast<float>(random.uniform(0.02, 0.4))});
    }
    PointCloud cloud(points.size());
    ASSERT_EQ(cloud.build(points, {Vec3::Zero(), 10.0}), CloudBuild::kBuilt);
    const BlindShell blind =
        shelve_own_points(part, relative_pose(Pose{}, Pose{}), shell, cloud,
                          {.most = most, .error = {.constant = error}, .along_ray = true});
    std::size_t gone = 0, far = 0;
    for (std::size_t b = 0; b < cloud.blocks(); ++b) {
      for (std::size_t lane = 0; lane < PointCloud::kFanOut; ++lane) {
        const MeasuredPoint& p = points[cloud.block(b).source[lane]];
        const Vec3 on_axis(0, 0, std::clamp(double{p.z}, 1.8, 2.2));
        const double d = (Vec3(p.x, p.y, p.z) - on_axis).norm() - 0.07;
        const bool is_there = cloud.block(b).is_present(lane);
        EXPECT_TRUE(is_there || d <= most + error + 1e-6) << d;
        EXPECT_TRUE(!is_there || d >= shell + error - 1e-6) << d;
        EXPECT_TRUE(is_there || d + p.radius <= blind.thickness + 1e-9) << d;
        gone += is_there ? 0 : 1;
        far += d > most + error && d < shell + p.radius ? 1 : 0;
      }
    }
    EXPECT_GT(gone, 50u);
    EXPECT_GT(far, 50u) << "balls that come within the shell";
  }
}

TEST(OwnPoints, RefittingATiledImageChangesNoDistance) {
  const ConvexBody part = made(box({0.2, 0.1, 0.15}));
  for (int seed = 0; seed < 10; ++seed) {
    Random random(static_cast<std::uint64_t>(seed) + 50);
    const std::vector<float> depth = noise(random);
    DepthCloud cloud(kCamera.width, kCamera.height);
    ASSERT_EQ(cloud.build(kCamera, image_of(depth), {0.001, 0.0025}, {0.25, 4.0}),
              DepthBuild::kBuilt);
    Pose place = random.pose(0.3);
    place.position.z() += 1.0;
    const RelativePose pose = relative_pose(place, {});
    SlabBody body;
    ASSERT_GT(shelve_own_points(part, pose, 0.01, cloud, body).elements, 0U);
    CloudTracking one, other;
    const NearestElement before = nearest_element(part, cloud, body, pose, one);
    cloud.refit();
    const NearestElement after = nearest_element(part, cloud, body, pose, other);
    EXPECT_GT(before.lower, 0.01 - 1e-12) << "all that is nearer is shelved";
    EXPECT_NEAR(before.lower, after.lower, 1e-9);
    EXPECT_NEAR(before.upper, after.upper, 1e-9);
  }
}

TEST(OwnPoints, ABadPoseShelvesNothing) {
  Random random(3);
  const std::vector<float> depth = noise(random);
  DepthCloud cloud(kCamera.width, kCamera.height);
  ASSERT_EQ(cloud.build(kCamera, image_of(depth), {0.001, 0.0025}, {0.25, 4.0}),
            DepthBuild::kBuilt);
  Pose bad;
  bad.position.x() = std::numeric_limits<double>::quiet_NaN();
  SlabBody body;
  EXPECT_EQ(
      shelve_own_points(made(point(Vec3::Zero(), 9.0)), relative_pose(bad, {}), 1.0, cloud, body)
          .elements,
      0U);
  EXPECT_EQ(cloud.size(), depth.size());
}

}  // namespace
}  // namespace clearance::own_points_test
