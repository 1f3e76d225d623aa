// Overlaps of curved bodies: the points that meet when B is moved by the depth, and the answers of
// bodies with radii. Oracles: closed forms, differences, and the same question with the depth.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "core/distance.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::at;
using test::made;

DistanceResult cold_of(const ConvexBody& a, const ConvexBody& b, const Pose& pose) {
  TrackingState state;
  return distance(a, b, Pose{}, pose, state);
}

// By how much the points miss each other when B is moved by the depth, m.
double miss(const DistanceResult& r) {
  return (r.point_on_b - r.point_on_a - r.distance * r.normal).norm();
}

// The pole of the ellipsoid is in the lower cap, beside its middle.
TEST(CurvedOverlap, OfACapHasPointsThatMeet) {
  const ConvexBody egg = made(ellipsoid({0.1, 0.1, 0.12})), disc = made(cylinder(0.3, 0.05));
  const DistanceResult r = cold_of(egg, disc, at(0.1, 0, 0.13));
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
  EXPECT_NEAR(r.distance, -0.04, 1e-12);
  EXPECT_LT(miss(r), 1e-11);
  EXPECT_NEAR(r.point_on_b.x(), 0.0, 1e-9) << "this is where the distance changes with B's motion";
  const DistanceResult swapped = cold_of(disc, egg, at(-0.1, 0, -0.13));
  EXPECT_LT(miss(swapped), 1e-11);
}

TEST(CurvedOverlap, OfTwoFlatFacesHasPointsThatMeetInBoth) {
  const std::vector<ConvexBody> below = {made(box({0.4, 0.3, 0.2})), made(cylinder(0.3, 0.2)),
                                         made(truncated_cone(0.4, 0.25, 0.2))};
  const std::vector<ConvexBody> above = {made(cylinder(0.05, 0.3)),
                                         made(truncated_cone(0.15, 0.05, 0.3))};
  Random random(11);
  for (int i = 0; i < 600; ++i) {
    const ConvexBody& a = below[i % 3];
    const ConvexBody& b = above[i / 3 % 2];
    const double depth = std::pow(10.0, random.uniform(-12.0, -2.0));
    Pose pose = at(random.uniform(-0.15, 0.15), random.uniform(-0.1, 0.1), 0.5 - depth);
    pose.orientation = Eigen::AngleAxisd(random.uniform(-3.0, 3.0), Vec3::UnitZ());
    const DistanceResult r = cold_of(a, b, pose);
    if (r.status != DistanceStatus::kOverlapping) continue;
    EXPECT_NEAR(r.distance, -depth, 1e-12) << i;
    EXPECT_LT(miss(r), 1e-11) << i << ", depth " << depth;
    EXPECT_NEAR(r.point_on_a.z(), 0.2, 1e-11) << i << ", depth " << depth;
  }
}

// The can's own surface touches the table's to rounding: only its padding overlaps.
TEST(CurvedOverlap, OfAPaddingAloneHasPointsOnBoth) {
  const double padding = 0.01;
  const ConvexBody table = made(box({0.5, 0.5, 0.02}));
  const ConvexBody can = made(cylinder(0.04, 0.1, padding));
  Random random(12);
  for (const double lift : {0.0, 1e-16, 1e-14, 1e-12, 1e-9, 1e-4}) {
    for (int i = 0; i < 100; ++i) {
      const Pose a{random.in_box(1.0), random.rotation()};
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(random.uniform(-3.0, 3.0), Vec3::UnitZ()));
      const Vec3 to(random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.12 + lift);
      const Pose b{a.position + a.orientation * to, (a.orientation * turn).normalized()};
      TrackingState state;
      const DistanceResult r = distance(table, can, a, b, state);
      ASSERT_NE(r.status, DistanceStatus::kIterationLimit) << lift;
      EXPECT_NEAR(r.distance, lift - padding, 1e-12);
      EXPECT_NEAR(r.point_on_b.z(), 0.02 + lift - padding, 1e-10) << lift;
      EXPECT_NEAR((r.point_on_b - r.point_on_a).dot(r.normal), r.distance, 1e-10) << lift;
    }
  }
}

// Bodies with radii whose cores overlap: how deep is not known.
TEST(CurvedOverlap, OfCoresIsNotMeasuredIfNobodyAsksForTheDepth) {
  const std::vector<ConvexBody> bodies = {
      made(box({0.1, 0.1, 0.1})), made(segment({0, 0, -0.1}, {0, 0, 0.1}, 0.03)),
      made(cylinder(0.1, 0.2, 0.02)), made(ellipsoid({0.1, 0.2, 0.15}, 0.03))};
  Random random(13);
  int asked = 0;
  for (int i = 0; i < 2000; ++i) {
    const ConvexBody& a = bodies[random.integer(0, 3)];
    const ConvexBody& b = bodies[random.integer(0, 3)];
    const Pose pose{random.in_box(0.2), random.rotation()};
    TrackingState state;
    const DistanceResult r = distance(a, b, relative_pose(Pose{}, pose), state, {.depth = false});
    const DistanceResult whole = cold_of(a, b, pose);
    EXPECT_LE(r.lower, whole.upper) << i;
    EXPECT_GE(r.upper, whole.lower) << i;
    if (r.status == DistanceStatus::kDepthNotAsked) {
      ++asked;
      EXPECT_FALSE(whole.lower > 0.0) << i;
    } else {
      EXPECT_GT(r.lower, -kInfinity) << i << ": what is answered is known";
      EXPECT_NE(r.status, DistanceStatus::kIterationLimit) << i;
    }
  }
  EXPECT_GT(asked, 500);
  TrackingState state;
  const DistanceResult r = distance(
      bodies[0], bodies[1], relative_pose(Pose{}, at(0.095, 0.02, 0.03)), state, {.depth = false});
  EXPECT_EQ(r.status, DistanceStatus::kDepthNotAsked);
}

}  // namespace
}  // namespace clearance
