// Spheres and capsules beside cylinders and cones. Oracle: the ellipsoid method in 50 digits
// (tests/shared/curved_oracle.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "core/distance.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/curved_judge.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

using hard::CurvedCase;
using test::at;

oracle::CurvedBody cone_of(double low, double high, double half_length, double radius = 0.0) {
  oracle::CurvedBody body;
  body.shape.kind = CurvedShape::Kind::kTruncatedCone;
  body.shape.discs = {Disc{-half_length, low}, Disc{half_length, high}};
  body.radius = radius;
  return body;
}
oracle::CurvedBody sphere_of(double radius, const Vec3& centre = Vec3::Zero()) {
  oracle::CurvedBody body;
  body.points = {centre};
  body.radius = radius;
  return body;
}
oracle::CurvedBody capsule_of(const Vec3& start, const Vec3& end, double radius) {
  oracle::CurvedBody body;
  body.points = {start, end};
  body.radius = radius;
  return body;
}

DistanceResult answer(const CurvedCase& c, TrackingState& state) {
  return distance(test::made(hard::curved_model(c.a)), test::made(hard::curved_model(c.b)),
                  c.pose_a, c.pose_b, state);
}

// Cold and tracked. Returns the status of the cold query.
DistanceStatus expect_no_faults_in_this_order(const CurvedCase& asked) {
  const CurvedJudge judge(asked);
  TrackingState state;
  const DistanceResult cold = answer(asked, state), tracked = answer(asked, state);
  for (const std::string& fault : judge.faults(cold)) ADD_FAILURE() << "cold: " << fault;
  for (const std::string& fault : judge.faults(tracked)) ADD_FAILURE() << "tracked: " << fault;
  return cold.status;
}
// The same with the bodies swapped as well.
DistanceStatus expect_no_faults(const CurvedCase& c, const std::string& what) {
  SCOPED_TRACE(what);
  (void)expect_no_faults_in_this_order({c.b, c.a, c.pose_b, c.pose_a});
  return expect_no_faults_in_this_order(c);
}

struct Sized {
  Random random;
  double size;

  double length() { return std::max(2.0 * kLeastExtent, size * random.log_uniform(0.02, 1.0)); }
  oracle::CurvedBody cone() {
    const double wide = length();
    const double other = random.chance(0.4) ? wide : random.chance(0.4) ? 0.0 : length();
    const double radius = random.chance(0.5) ? 0.0 : length();
    return random.chance(0.5) ? cone_of(wide, other, length(), radius)
                              : cone_of(other, wide, length(), radius);
  }
  oracle::CurvedBody segment() {
    const double radius = random.chance(0.3) ? 0.0 : length();
    const Vec3 start = random.chance(0.4) ? Vec3(Vec3::Zero()) : random.in_box(size);
    if (random.chance(0.5)) return sphere_of(radius, start);
    return capsule_of(start, start + length() * random.direction(), radius);
  }
};

TEST(SegmentAndCone, HasBoundsThatHoldIn50DigitsFromTinyToHuge) {
  for (const double size : {1e-10, 1.0, 1e10}) {
    Sized of{Random(static_cast<std::uint64_t>(size)), size};
    int converged = 0;
    for (int i = 0; i < 40; ++i) {
      const CurvedCase c{of.cone(), of.segment(), of.random.pose(3.0 * size),
                         of.random.pose(3.0 * size)};
      const std::string what = std::to_string(i);
      converged += expect_no_faults(c, what) == DistanceStatus::kConverged ? 1 : 0;
    }
    EXPECT_GE(converged, 20) << size;
  }
}

TEST(SegmentAndCone, IsAnsweredOverCapsBesideSidesAndAtRims) {
  const std::vector<oracle::CurvedBody> cones = {cone_of(0.5, 0.5, 1.0), cone_of(0.5, 0.0, 1.0),
                                                 cone_of(0.25, 1.0, 0.5, 0.125)};
  const std::vector<Vec3> places = {
      {0, 0, 3},        {0, 0, -3},         {0.25, 0, 2},     {2, 0, 0},         {0, -2, 0.5},
      {1, 0, 1},        {0.5, 0, 1.5},      {0.5, 0, -1.5},   {2, 2, 2},         {1e-9, 0, 2},
      {0, 0, 1 + 1e-9}, {0.5 + 1e-9, 0, 0}, {0.5, 1e-12, -2}, {1e-300, 0, -1.5}, {3, 0, -1}};
  for (const oracle::CurvedBody& cone : cones) {
    for (const Vec3& place : places) {
      const Pose there{place, {1, 0, 0, 0}};
      for (const double radius : {0.0, 0.125}) {
        expect_no_faults({cone, sphere_of(radius), at(0, 0, 0), there}, "sphere");
        for (const Vec3& along : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 1)}) {
          expect_no_faults(
              {cone, capsule_of(-0.5 * along, 0.75 * along, radius), at(0, 0, 0), there},
              "capsule");
        }
      }
    }
  }
}

TEST(SegmentAndCone, IsAnsweredThatTouchesOrPenetrates) {
  const oracle::CurvedBody cylinder = cone_of(0.5, 0.5, 1.0);
  for (const double x : {0.0, 0.1, 0.5 - 1e-12, 0.5, 0.5 + 1e-12, 0.75, 1.0}) {
    expect_no_faults({cylinder, sphere_of(0.25), at(0, 0, 0), at(x, 0, 0)}, "sphere aside");
    expect_no_faults({cylinder, sphere_of(0.25), at(0, 0, 0), at(0.25, 0, 0.5 + x)}, "above");
    expect_no_faults({cylinder, capsule_of({0, 0, -2}, {0, 0, 2}, 0.25), at(0, 0, 0), at(x, 0, 0)},
                     "capsule along the axis");
  }
}

// Oracles: no direction has a smaller depth, and the ball of that radius around the point is in the
// cone, by what a cone is: heights, and a radius at each.
TEST(SegmentAndCone, OfAPointInsideHasTheRadiusOfTheLargestBallAroundItAsItsDepth) {
  Random random(12);
  int answered = 0;
  for (int i = 0; i < 300; ++i) {
    const double low = random.chance(0.2) ? 0.0 : random.log_uniform(0.05, 1.0);
    const double high = low > 0.0 && random.chance(0.3) ? low : random.log_uniform(0.05, 1.0);
    const double half = random.log_uniform(0.05, 1.0);
    const auto radius_at = [&](double z) { return low + (high - low) * (z + half) / (2.0 * half); };
    const double z = random.uniform(-half, half), angle = random.uniform(0.0, 6.28);
    const double across = radius_at(z) * random.uniform(0.0, 1.0);
    const Vec3 p(across * std::cos(angle), across * std::sin(angle), z);
    const CurvedCase c{cone_of(low, high, half), sphere_of(0.0, p), at(0, 0, 0), at(0, 0, 0)};
    (void)expect_no_faults(c, std::to_string(i));
    TrackingState state;
    const DistanceResult r = answer(c, state);
    if (r.upper >= -1e-9) continue;
    answered += r.iterations == 1;
    EXPECT_LE(r.upper - r.lower, 1e-13) << i;
    for (int k = 0; k < 300; ++k) {
      const Vec3 n = random.direction();
      const double side = std::hypot(n.x(), n.y());
      const double support = std::max(-half * n.z() + low * side, half * n.z() + high * side);
      ASSERT_GE(support - n.dot(p), -r.upper - 1e-14) << i;
      const Vec3 q = p - r.upper * n;
      ASSERT_LE(std::abs(q.z()), half + 1e-14) << i;
      ASSERT_LE(std::hypot(q.x(), q.y()), radius_at(q.z()) + 1e-14) << i;
    }
    EXPECT_NEAR(r.normal.dot(r.point_on_b - r.point_on_a), r.distance, 1e-14) << i;
  }
  EXPECT_GE(answered, 280);
}

TEST(SegmentAndCone, IsAnsweredAlongASideWithinATilt) {
  const oracle::CurvedBody cylinder = cone_of(0.5, 0.5, 1.0);
  const oracle::CurvedBody capsule = capsule_of({0, 0, -2}, {0, 0, 0.5}, 0.125);
  for (const double tilt : {0.0, 1e-15, 1e-12, 1e-8, 1e-3, 0.3}) {
    for (const double gap : {1e-9, 1e-3, 1.0}) {
      const Pose beside{{0.5 + 0.125 + gap, 0, 0}, test::turned({0, 1, 0}, tilt)};
      expect_no_faults({cylinder, capsule, at(0, 0, 0), beside}, "along the side");
      const Pose above{{0, 0, 1.0 + 0.125 + gap},
                       test::turned({0, 1, 0}, 0.5 * std::numbers::pi + tilt)};
      expect_no_faults({cylinder, capsule, at(0, 0, 0), above}, "along a cap");
    }
  }
}

TEST(SegmentAndCone, GivesTheSameBitsColdTrackedAndByARelativePose) {
  Sized of{Random(7), 1.0};
  int closed_forms = 0;
  for (int i = 0; i < 1000; ++i) {
    const ConvexBody a = test::made(hard::curved_model(of.cone()));
    const ConvexBody b = test::made(hard::curved_model(of.segment()));
    const Pose pose_a = of.random.pose(3.0), pose_b = of.random.pose(3.0);
    TrackingState cold, tracked, relative;
    const DistanceResult first = distance(a, b, pose_a, pose_b, cold);
    EXPECT_TRUE(same_bits(first, distance(a, b, relative_pose(pose_a, pose_b), relative))) << i;
    if (first.iterations != 1) continue;
    ++closed_forms;
    Pose before = pose_b;
    before.position += 0.05 * of.random.direction();
    (void)distance(a, b, pose_a, before, tracked);
    EXPECT_TRUE(same_bits(first, distance(a, b, pose_a, pose_b, tracked))) << i;
  }
  EXPECT_GE(closed_forms, 500);
}

TEST(SegmentAndCone, AllocatesNothing) {
  const ConvexBody a = test::made(hard::curved_model(cone_of(0.5, 0.25, 1.0)));
  const ConvexBody b = test::made(hard::curved_model(capsule_of({-1, 0, 0}, {1, 0, 0}, 0.1)));
  Random random(8);
  for (int i = 0; i < 100; ++i) {
    const Pose pose_a = random.pose(2.0), pose_b = random.pose(2.0);
    TrackingState state;
    const std::uint64_t before = allocations();
    (void)distance(a, b, pose_a, pose_b, state);
    EXPECT_EQ(allocations(), before) << i;
  }
}

}  // namespace
}  // namespace clearance
