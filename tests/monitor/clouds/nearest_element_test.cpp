// Oracle: the core's general query of the part and each ball, as a body of its own, without planes,
// boxes or an order of the elements.
#include "monitor/clouds/nearest_element.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using Points = std::vector<MeasuredPoint>;

const CloudCrop kCrop{Vec3::Zero(), 100.0};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kEndless = std::numeric_limits<float>::infinity();

PointCloud built(const Points& points) {
  PointCloud cloud(points.size());
  EXPECT_EQ(cloud.build(points, kCrop), CloudBuild::kBuilt);
  return cloud;
}

// The least bounds over all elements.
NearestElement by_brute_force(const ConvexBody& part, const Points& points, const Pose& pose_part,
                              const Pose& pose_cloud) {
  NearestElement least;
  for (const MeasuredPoint& p : points) {
    if (!std::isfinite(p.x + p.y + p.z)) continue;
    const ConvexBody ball = test::made(point({p.x, p.y, p.z}, p.radius));
    TrackingState state;
    const DistanceResult r = distance(part, ball, pose_part, pose_cloud, state);
    least.lower = std::min(least.lower, r.lower);
    least.upper = std::min(least.upper, r.upper);
  }
  return least;
}

std::vector<ConvexBody> parts() {
  std::vector<ConvexBody> out;
  out.push_back(test::made(box({0.3, 0.1, 0.05})));
  out.push_back(test::made(segment({0, 0, -0.2}, {0, 0, 0.2}, 0.07)));
  out.push_back(test::made(point({0.1, 0, 0}, 0.2)));
  out.push_back(test::made(hard::facet_ball(4)));
  out.push_back(test::made(cylinder(0.1, 0.3)));
  out.push_back(test::made(ellipsoid({0.3, 0.2, 0.1})));
  out.push_back(test::made(truncated_cone(0.2, 0.1, 0.3, 0.01)));
  out.push_back(test::half_space({0, 0.6, 0.8}, 0.1));
  return out;
}

MeasuredPoint measured(const Vec3& at, double radius) {
  return {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z()),
          static_cast<float>(radius)};
}

// A box of points, a plane of them, a ball's surface, or a crowd at few places.
Points drawn(Random& random, std::size_t count) {
  const int kind = random.integer(0, 3);
  const double size = random.log_uniform(0.01, 5.0), radius = random.uniform(0.0, 0.02);
  const Vec3 middle = random.in_box(2.0);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 at = random.in_box(size);
    if (kind == 1) at.z() = 0.0;
    if (kind == 2) at = size * random.direction();
    if (kind == 3) at = Vec3::Constant(size * random.integer(0, 2));
    points.push_back(measured(middle + at, radius * random.unit()));
    if (random.chance(0.02)) points.back().y = kNan;
  }
  return points;
}

void expect_agrees(const NearestElement& got, const NearestElement& truth, const std::string& of) {
  EXPECT_EQ(got.answer, CloudAnswer::kNearest) << of;
  // Both pairs of bounds contain the same distance.
  EXPECT_LE(got.lower, truth.upper) << of;
  EXPECT_GE(got.upper, truth.lower) << of;
  EXPECT_LE(got.upper - got.lower, 1e-9) << of;
  EXPECT_NEAR((got.point_on_element - got.point_on_part).dot(got.normal), got.upper, 2e-9) << of;
}

TEST(NearestElement, BoundsAreThoseOfBruteForceForEveryKindOfPart) {
  const char* const asked = std::getenv("CLEARANCE_CLOUD_SEEDS");
  const int seeds = asked == nullptr ? 40 : std::atoi(asked);
  const std::vector<ConvexBody> all = parts();
  for (int seed = 0; seed < static_cast<int>(repeats(static_cast<std::uint64_t>(seeds))); ++seed) {
    Random random(static_cast<std::uint64_t>(seed) * 1000003);
    const Points points = drawn(random, static_cast<std::size_t>(random.integer(1, 300)));
    const PointCloud cloud = built(points);
    if (cloud.size() == 0) continue;
    const Pose pose_cloud = random.pose(2.0);
    for (std::size_t i = 0; i < all.size(); ++i) {
      CloudTracking tracking;
      const Pose start = random.pose(2.0), end = random.pose(2.0);
      for (int step = 0; step < 3; ++step) {  // the first is cold, the others are tracked
        const Pose pose = test::between(start, end, 0.05 * step);
        const std::string of = "seed " + std::to_string(seed) + ", part " + std::to_string(i) +
                               ", step " + std::to_string(step);
        expect_agrees(nearest_element(all[i], cloud, relative_pose(pose, pose_cloud), tracking),
                      by_brute_force(all[i], points, pose, pose_cloud), of);
      }
    }
  }
}

TEST(NearestElement, ATrackingStateOfAnotherCloudCostsNoTruth) {
  Random random(5);
  const ConvexBody part = test::made(box({0.3, 0.1, 0.05}));
  const Points points = drawn(random, 100);
  const PointCloud cloud = built(points);
  for (const std::uint32_t block : {1U, 12U, 13U, 0xFFFFFFFFU}) {
    CloudTracking tracking;
    tracking.block = block;
    tracking.features.a.kind = FeatureKind::kFacet;
    tracking.features.a.feature = 1 << 20;
    expect_agrees(nearest_element(part, cloud, relative_pose({}, {}), tracking),
                  by_brute_force(part, points, {}, {}), std::to_string(block));
  }
}

TEST(NearestElement, OfAnEmptyCloudIsNoElementAndNoDistance) {
  CloudTracking tracking;
  const NearestElement r = nearest_element(test::cube(), built({}), {}, tracking);
  EXPECT_EQ(r.answer, CloudAnswer::kEmpty);
  const PointCloud missing = built(Points(20, {kNan, 0, 0, 0}));
  EXPECT_EQ(missing.missing(), 20U);
  EXPECT_EQ(nearest_element(test::cube(), missing, {}, tracking).answer, CloudAnswer::kEmpty);
}

TEST(NearestElement, OfABadPoseIsUnknown) {
  CloudTracking tracking;
  Pose bad;
  bad.position.x() = kNan;
  const NearestElement r =
      nearest_element(test::cube(), built({{2, 0, 0, 0}}), relative_pose({}, bad), tracking);
  EXPECT_EQ(r.answer, CloudAnswer::kBadPose);
  EXPECT_EQ(r.lower, -kInfinity);
  EXPECT_EQ(r.upper, kInfinity);
}

TEST(NearestElement, OfOnePointIsItsBall) {
  CloudTracking tracking;
  const NearestElement r =
      nearest_element(test::cube(), built({{2.5F, 0, 0, 0.25F}}), {}, tracking);
  EXPECT_NEAR(r.lower, 1.75, 1e-12);
  EXPECT_NEAR(r.upper, 1.75, 1e-12);
  EXPECT_NEAR((r.point_on_element - Vec3(2.25, 0, 0)).norm(), 0.0, 1e-12);
}

TEST(NearestElement, InsideThePartIsTheDeepestBall) {
  Points points;
  for (int i = 0; i < 50; ++i) points.push_back({0.01F * static_cast<float>(i), 0, 0, 0.1F});
  CloudTracking tracking;
  const NearestElement r = nearest_element(test::cube(), built(points), {}, tracking);
  const double depth = 0.5 + double{0.1F};
  EXPECT_NEAR(r.lower, -depth, 1e-12);
  EXPECT_NEAR(r.upper, -depth, 1e-12);
  EXPECT_EQ(r.source, 0U);
}

// A query of an ellipsoid and a point in it costs much, and some 2,500 points are in it.
TEST(NearestElement, DeepInACloudTheWorkIsBoundedAndBothBoundsHold) {
  Random random(17);
  Points points;
  for (int i = 0; i < 4000; ++i) points.push_back(measured(random.in_box(0.1), 0.002));
  const PointCloud cloud = built(points);
  const ConvexBody part = test::made(ellipsoid({0.1, 0.09, 0.3}));
  CloudTracking tracking;
  for (int step = 0; step < 5; ++step) {
    const Pose pose = {.position = {0.01 * step, 0.0, 0.0}};
    const NearestElement got = nearest_element(part, cloud, relative_pose(pose, Pose()), tracking);
    const NearestElement truth = by_brute_force(part, points, pose, Pose());
    EXPECT_FALSE(got.within_work_limit);
    EXPECT_LE(got.overlap_work, kMostOverlapWork + kCostOfCurved);
    EXPECT_LE(got.lower, truth.upper);
    EXPECT_GE(got.upper, truth.lower);
    EXPECT_LT(got.upper, 0.0);
    EXPECT_GT(got.lower, -0.5) << "planes bound what was not queried";
  }
  // Apart, as many elements as it takes are looked at.
  const NearestElement apart =
      nearest_element(part, cloud, relative_pose({.position = {0.3, 0.0, 0.0}}, Pose()), tracking);
  EXPECT_TRUE(apart.within_work_limit);
  EXPECT_LE(apart.upper - apart.lower, 1e-9);
}

// Every point of a wall that is parallel to a face is nearest.
TEST(NearestElement, OfAWallThatIsParallelToAFaceNeedsFewQueries) {
  Points points;
  for (int i = 0; i < 550; ++i) {
    for (int k = 0; k < 550; ++k) {
      const float x = 0.005F * static_cast<float>(i - 275),
                  y = 0.005F * static_cast<float>(k - 275);
      points.push_back({x, y, 1.0F, 0.001F});
    }
  }
  CloudTracking tracking;
  const PointCloud cloud = built(points);
  ASSERT_GE(cloud.size(), 300000U);
  const NearestElement cold = nearest_element(test::cube(), cloud, {}, tracking);
  EXPECT_NEAR(cold.lower, 0.5 - double{0.001F}, 1e-9);
  EXPECT_LE(cold.upper - cold.lower, 1e-9);
  EXPECT_LE(cold.queries, 200U);
  EXPECT_LE(nearest_element(test::cube(), cloud, {}, tracking).queries, 20U);
}

// The error of the pose makes the bounds of a curved part wider than its rounding.
TEST(NearestElement, OfACurvedPartNeedsFewQueriesWhateverTheErrorOfThePose) {
  Random random(31);
  Points points;
  for (int i = 0; i < 200; ++i) {
    for (int k = 0; k < 200; ++k)
      points.push_back(
          {0.02F * static_cast<float>(i), 0.02F * static_cast<float>(k), 2.0F, 0.001F});
  }
  const PointCloud cloud = built(points);
  for (const ConvexBody& part :
       {test::made(cylinder(0.05, 0.12)), test::made(ellipsoid({0.3, 0.2, 0.1})),
        test::made(truncated_cone(0.2, 0.1, 0.3, 0.01))}) {
    CloudTracking tracking;
    for (int step = 0; step < 20; ++step) {
      Pose part_in_cloud = random.pose(1.0);
      part_in_cloud.position.z() = 0.5;
      RelativePose pose = relative_pose(part_in_cloud, Pose());
      pose.translation_error = 1e-12 * step;
      const NearestElement found = nearest_element(part, cloud, pose, tracking);
      EXPECT_GT(found.lower, 0.5);
      EXPECT_LE(found.queries, 400u) << "of 40,000 points";
    }
  }
}

TEST(NearestElement, AllocatesNothingAndRepeatsToTheBit) {
  Random random(9);
  const Points points = drawn(random, 3000);
  PointCloud first(points.size()), second(points.size());
  const ConvexBody part = test::made(ellipsoid({0.1, 0.09, 0.3}));
  const RelativePose pose = relative_pose(random.pose(1.0), random.pose(1.0));
  CloudTracking one, other;
  const std::uint64_t before = allocations();
  const CloudBuild build = first.build(points, kCrop);
  const NearestElement a = nearest_element(part, first, pose, one);
  EXPECT_EQ(allocations(), before);
  ASSERT_EQ(build, CloudBuild::kBuilt);
  // A cloud before this one leaves no trace.
  ASSERT_EQ(second.build(drawn(random, 500), kCrop), CloudBuild::kBuilt);
  ASSERT_EQ(second.build(points, kCrop), CloudBuild::kBuilt);
  const NearestElement b = nearest_element(part, second, pose, other);
  EXPECT_EQ(a.lower, b.lower);
  EXPECT_EQ(a.upper, b.upper);
  EXPECT_EQ(a.point_on_part, b.point_on_part);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.queries, b.queries);
}

TEST(PointCloud, KeepsExactlyThePointsWhoseBallsMeetTheCrop) {
  const Points points{{0.5F, 0, 0, 0}, {2, 0, 0, 1.5F}, {2, 0, 0, 0.5F}, {kEndless, 0, 0, 0}};
  PointCloud cloud(2);
  ASSERT_EQ(cloud.build(points, {Vec3::Zero(), 1.0}), CloudBuild::kBuilt);
  EXPECT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.cropped(), 1U);
  EXPECT_EQ(cloud.missing(), 1U);
}

TEST(PointCloud, RefusesWhatItCannotHoldAndKeepsTheFormerPoints) {
  PointCloud cloud(2);
  ASSERT_EQ(cloud.build(Points{{1, 0, 0, 0}}, kCrop), CloudBuild::kBuilt);
  const auto refused = [&](const Points& points, const CloudCrop& crop) {
    const CloudBuild result = cloud.build(points, crop);
    EXPECT_EQ(cloud.size(), 1U);
    EXPECT_EQ(cloud.block(0).x[0], 1.0F);
    return result;
  };
  EXPECT_EQ(refused(Points(3, {2, 0, 0, 0}), kCrop), CloudBuild::kTooManyPoints);
  EXPECT_EQ(refused({{2, 0, 0, -1}}, kCrop), CloudBuild::kBadRadius);
  EXPECT_EQ(refused({{2, 0, 0, kNan}}, kCrop), CloudBuild::kBadRadius);
  EXPECT_EQ(refused({{2, 0, 0, kEndless}}, kCrop), CloudBuild::kBadRadius);
  EXPECT_EQ(refused({{2, 0, 0, 0}}, {Vec3::Zero(), kInfinity}), CloudBuild::kBadCrop);
  EXPECT_EQ(refused({{2, 0, 0, 0}}, {Vec3::Zero(), -1.0}), CloudBuild::kBadCrop);
  EXPECT_EQ(refused({{2, 0, 0, 0}}, {Vec3(kNan, 0, 0), 1.0}), CloudBuild::kBadCrop);
  EXPECT_EQ(refused({{2, 0, 0, 0}}, {Vec3(0, kNan, 0), 1.0}), CloudBuild::kBadCrop);
  EXPECT_EQ(refused({{2, 0, 0, 0}}, {Vec3(0, 0, kNan), 1.0}), CloudBuild::kBadCrop);
  EXPECT_EQ(refused({{2, 0, 0, 0}}, {Vec3(1e7, 0, 0), 1.0}), CloudBuild::kBadCrop);
}

}  // namespace
}  // namespace clearance
