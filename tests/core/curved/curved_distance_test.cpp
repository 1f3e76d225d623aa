// Distances of curved bodies against closed forms, against published figures and against the
// polyhedral query, which proves its answers by other means.
#include "core/curved/curved_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::at;
using test::made;

constexpr double kHalfTurn = std::numbers::pi;

DistanceResult cold(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const Pose& world_from_a,
                    const Pose& world_from_b) {
  return test::cold(a, b, relative_pose(world_from_a, world_from_b));
}

Pose turned_at(double x, double y, double z, const Vec3& axis, double angle) {
  return {{x, y, z}, test::turned(axis, angle)};
}

// The bounds hold the exact answer and are as near to each other as promised.
void expect_answer(const DistanceResult& r, double exact, double size, double rounding = 0.0) {
  EXPECT_LE(r.lower, exact + rounding);
  EXPECT_GE(r.upper, exact - rounding);
  EXPECT_LE(r.upper - r.lower, 1e-13 * size);
  EXPECT_NEAR(r.distance, exact, 1e-14 * size);
}

TEST(CurvedDistance, OfTheThesissCrossedEllipsoidsIsTheKnownOne) {
  // (5.2.2) gives the points to 1e-11; the distance is 1.29549481993874080913966969921.
  const ConvexPolyhedron a = made(ellipsoid({1, 2, 5})), b = made(ellipsoid({5, 2, 1}));
  const DistanceResult r = cold(a, b, at(0, 0, 0), at(4, 4, 4));
  expect_answer(r, 1.29549481993874080914, 10.0 + 6.9);
  EXPECT_NEAR(r.point_on_a.x(), 0.13705777781256, 1e-10);
  EXPECT_NEAR(r.point_on_a.y(), 1.43051641611194, 1e-10);
  EXPECT_NEAR(r.point_on_a.z(), 3.42644444486425, 1e-10);
  EXPECT_EQ(r.status, DistanceStatus::kConverged);
}

TEST(CurvedDistance, OfSpheresMadeAnyWayIsThatOfTheirCentresLessTheRadii) {
  const ConvexPolyhedron point = made(clearance::point({0, 0, 0}, 0.75));
  const ConvexPolyhedron round[] = {made(ellipsoid({0.75, 0.75, 0.75})), point,
                                    made(ellipsoid({0.5, 0.5, 0.5}, 0.25))};
  for (const ConvexPolyhedron& a : round) {
    for (const ConvexPolyhedron& b : round) {
      expect_answer(cold(a, b, at(0, 0, 0), at(3, 4, 0)), 3.5, 6.5);
      expect_answer(cold(a, b, at(0, 0, 0), at(0.75, 0, 0)), -0.75, 2.25);
    }
  }
}

TEST(CurvedDistance, OfCylindersIsThatOfCapsSidesAndRims) {
  const ConvexPolyhedron a = made(cylinder(1.0, 2.0)), b = made(cylinder(0.5, 1.0));
  expect_answer(cold(a, b, at(0, 0, 0), at(0, 0, 4)), 1.0, 8.0);     // coaxial
  expect_answer(cold(a, b, at(0, 0, 0), at(1.25, 0, 4)), 1.0, 8.0);  // caps half over each other
  expect_answer(cold(a, b, at(0, 0, 0), at(3, 0, 0.5)), 1.5, 8.0);   // side by side
  expect_answer(cold(a, b, at(0, 0, 0), at(4.5, 0, 7)), 5.0, 15.0);  // rim to rim, 3 and 4
  const Pose crossed = turned_at(3, 0, 0, Vec3::UnitX(), kHalfTurn / 2);
  expect_answer(cold(a, b, at(0, 0, 0), crossed), 1.5, 8.0, 1e-16);
}

TEST(CurvedDistance, OfConesIsThatOfApexBaseAndSide) {
  const ConvexPolyhedron cone_a = made(cone(1.0, 1.0)), sphere = made(ellipsoid({1, 1, 1}));
  expect_answer(cold(cone_a, sphere, at(0, 0, 0), at(0, 0, 4)), 2.0, 8.0);
  expect_answer(cold(cone_a, sphere, at(0, 0, 0), at(0, 0, -4)), 2.0, 8.0);
  // The side leads from (1, -1) to (0, 1); its outward normal is (2, 1) / sqrt 5.
  const double side = (2.0 * 3.0 + 1.0 * 1.5 - 1.0) / std::sqrt(5.0) - 1.0;
  expect_answer(cold(cone_a, sphere, at(0, 0, 0), at(3, 0, 1.5)), side, 8.0);
}

TEST(CurvedDistance, OfAHalfSpaceIsThatOfOneSupportPoint) {
  const HalfSpace rows[] = {{{0, 0, 1}, 0.0}};
  const ConvexPolyhedron floor = made(polyhedron_from_halfspaces(rows));
  const ConvexPolyhedron ground = floor, body = made(ellipsoid({3, 2, 1}));
  expect_answer(cold(ground, body, at(0, 0, 0), at(5, 6, 4)), 3.0, 12.0);
  expect_answer(cold(body, ground, at(5, 6, 4), at(0, 0, 0)), 3.0, 12.0);
  expect_answer(cold(ground, body, at(0, 0, 0), at(5, 6, 0.25)), -0.75, 12.0);
}

TEST(CurvedDistance, OfParallelCapsTiltedByLittleIsThatOfTheLowerRim) {
  const ConvexPolyhedron a = made(cylinder(1.0, 1.0)), b = made(cylinder(0.5, 1.0));
  for (double tilt = 1e-14; tilt < 1e-2; tilt *= 10.0) {
    const Pose pose = turned_at(0, 0, 3, Vec3::UnitY(), tilt);
    const double exact = 3.0 - std::cos(tilt) - 0.5 * std::sin(tilt) - 1.0;
    expect_answer(cold(a, b, at(0, 0, 0), pose), exact, 6.0, 4e-16);
  }
}

TEST(CurvedDistance, OfDiscsAndNeedlesIsRightAlongTheirAxes) {
  const ConvexPolyhedron disc = made(ellipsoid({1, 1, 1e-4}));
  const ConvexPolyhedron needle = made(ellipsoid({1e-4, 1e-4, 1}));
  expect_answer(cold(disc, needle, at(0, 0, 0), at(0, 0, 2)), 1.0 - 1e-4, 5.0);
  expect_answer(cold(disc, disc, at(0, 0, 0), at(0, 0, 1)), 1.0 - 2e-4, 4.0);
  expect_answer(cold(needle, needle, at(0, 0, 0), at(1, 0, 0)), 1.0 - 2e-4, 4.0);
}

TEST(CurvedDistance, OfBodiesThatOverlapIsMinusTheShortestWayOut) {
  const ConvexPolyhedron a = made(cylinder(1.0, 3.0)), b = made(ellipsoid({0.5, 0.5, 2}));
  // Sideways, 1.5 - 1 = 0.5 is shorter than lengthwise, 5.
  expect_answer(cold(a, b, at(0, 0, 0), at(1, 0, 0)), -0.5, 7.0);
  const DistanceResult r = cold(a, b, at(0, 0, 0), at(0, 0, 4.75));
  expect_answer(r, -0.25, 10.0);
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
  EXPECT_NEAR(r.normal.z(), 1.0, 1e-7);
}

TEST(CurvedDistance, OfEllipsoidsWithOneCentreIsTheSumOfTheirShortestSemiAxes) {
  const ConvexPolyhedron a = made(ellipsoid({1, 2, 5})), b = made(ellipsoid({1.5, 2, 3}));
  expect_answer(cold(a, b, at(0, 0, 0), at(0, 0, 0)), -2.5, 8.0);
}

TEST(CurvedDistance, OfPolyhedraEnclosesWhatThePolyhedralQueryEncloses) {
  Random random(21);
  for (int k = 0; k < 400; ++k) {
    const ConvexPolyhedron p = made(box({random.log_uniform(0.1, 1), 0.5, 1}));
    const ConvexPolyhedron q = made(box({1, random.log_uniform(0.1, 1), 0.25}));
    const RelativePose pose = relative_pose(random.pose(1.5), random.pose(1.5));
    TrackingState state;
    CurvedTrackingState curved;
    const DistanceResult r = distance(p, q, pose, state);
    const DistanceResult s = curved_distance(p, q, pose, curved);
    EXPECT_LE(r.lower, s.upper) << k;
    EXPECT_LE(s.lower, r.upper) << k;
    EXPECT_LE(s.upper - s.lower, 1e-13 * (p.bounding_radius + q.bounding_radius + 5.0)) << k;
  }
}

TEST(CurvedDistance, TakesAnyStateAndNoHeap) {
  const ConvexPolyhedron a = made(cylinder(1, 1)), b = made(ellipsoid({1, 2, 3}));
  const RelativePose pose = relative_pose(at(0, 0, 0), at(4, 1, 0));
  CurvedTrackingState empty;
  const DistanceResult r = curved_distance(a, b, pose, empty);
  CurvedTrackingState nonsense;
  nonsense.normal = Vec3(0, 0, -1);
  nonsense.active.count = 2;
  nonsense.active.pieces = {PiecePair{7, -3}, PiecePair{0, 0}, PiecePair{}};
  const std::uint64_t before = allocations();
  const DistanceResult s = curved_distance(a, b, pose, nonsense);
  EXPECT_EQ(allocations(), before);
  EXPECT_LE(r.lower, s.upper);
  EXPECT_LE(s.lower, r.upper);
  EXPECT_EQ(s.status, DistanceStatus::kConverged);
}

TEST(CurvedDistance, OfABadPoseIsUnknown) {
  const ConvexPolyhedron a = made(cylinder(1, 1));
  Pose bad = at(0, 0, 0);
  bad.position.x() = std::nan("");
  const DistanceResult r = cold(a, a, at(0, 0, 0), bad);
  EXPECT_EQ(r.status, DistanceStatus::kBadPose);
  EXPECT_EQ(r.upper, kInfinity);
}

}  // namespace
}  // namespace clearance
