// The depth of pairs whose symmetry gives many deepest directions, compared with closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/curved/thorough.hpp"
#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

using test::at;
using test::made;

// The depth is certified from both sides to 1e-13 of the size.
void expect_depth(const ConvexBody& a, const ConvexBody& b, const Pose& pose, double depth,
                  double slack = 0.0) {
  const DistanceResult r = test::cold(a, b, relative_pose(at(0, 0, 0), pose));
  const double size = a.bounding_radius + b.bounding_radius + pose.position.norm();
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping) << r.upper - r.lower;
  EXPECT_LE(r.lower, -depth + slack);
  EXPECT_GE(r.upper, -depth - slack);
  EXPECT_LE(r.upper - r.lower, 1e-13 * size);
}

// The depth of coaxial solids of revolution is that of their sections. It is the smallest
// translation along the axis or along a normal of one of the sections' sides.
double coaxial_depth(const Vec2 (&a)[2], const Vec2 (&b)[2], double apart) {
  const auto support_value = [](const Vec2(&s)[2], double x, double y) {
    return std::max(s[0].x() * x + s[0].y() * y, s[1].x() * x + s[1].y() * y);
  };
  const auto along = [&](double x, double y) {
    return support_value(a, x, y) + support_value(b, -x, y) - apart * x;
  };
  double least = std::min(along(1, 0), along(-1, 0));
  const auto side = [&](const Vec2(&s)[2], double sign) {
    const Vec2 n = Vec2(s[0].y() - s[1].y(), s[1].x() - s[0].x()).normalized();
    least = std::min(least, along(sign * n.x(), n.y()));
  };
  side(a, 1.0);
  side(b, -1.0);
  return least;
}

TEST(SymmetricDepth, OfCoaxialTruncatedConesIsThatOfTheirSections) {
  Random random(41);
  for (int k = 0; k < 40; ++k) {
    const double h = random.uniform(0.2, 1.0), i = random.uniform(0.2, 1.0);
    const Vec2 a[2] = {{-h, random.uniform(0.0, 1.0)}, {h, random.uniform(0.1, 1.0)}};
    const Vec2 b[2] = {{-i, random.uniform(0.1, 1.0)}, {i, random.uniform(0.0, 1.0)}};
    const double apart = random.uniform(-0.7, 0.7) * (h + i);
    const ConvexBody body_a = made(truncated_cone(a[0].y(), a[1].y(), h));
    const ConvexBody body_b = made(truncated_cone(b[0].y(), b[1].y(), i));
    expect_depth(body_a, body_b, at(0, 0, apart), coaxial_depth(a, b, apart), 1e-15);
  }
}

TEST(SymmetricDepth, OfCoaxialCylindersIsThatOfTheirRadiiOrTheirEnds) {
  const ConvexBody a = made(cylinder(0.5, 2.0)), b = made(cylinder(0.25, 1.0));
  expect_depth(a, b, at(0, 0, 0.5), 0.75);
  expect_depth(a, b, at(0, 0, 2.5), 0.5);
  const Vec3 across(1, 0, 0);
  const Pose upside_down{Vec3(0, 0, 0.5), test::turned(across, std::numbers::pi)};
  expect_depth(a, b, upside_down, 0.75, 1e-15);
}

TEST(SymmetricDepth, OfABallOnTheAxisOfASolidOfRevolutionIsKnown) {
  const ConvexBody ball = made(ellipsoid({0.5, 0.5, 0.5}));
  expect_depth(ball, made(cylinder(1.0, 2.0)), at(0, 0, 0), 1.5);
  expect_depth(made(cylinder(1.0, 2.0)), ball, at(0, 0, 0.75), 1.5);
  // The distance of a point on the axis from the spheroid is sqrt(1 - z^2 / 8), derived by hand
  // from its section.
  expect_depth(ball, made(ellipsoid({1, 1, 3})), at(0, 0, 0.5), 0.5 + std::sqrt(1.0 - 0.25 / 8.0),
               1e-15);
  expect_depth(ball, ball, at(0.25, 0, 0), 0.75);
  expect_depth(ball, ball, at(0, 0, 0), 1.0);
}

TEST(SymmetricDepth, OfEllipsoidsAroundOneCentreIsTheLeastSumOfTwoSemiAxes) {
  expect_depth(made(ellipsoid({1, 1, 5})), made(ellipsoid({2, 2, 3})), at(0, 0, 0), 3.0);
  expect_depth(made(ellipsoid({1, 2, 3})), made(ellipsoid({3, 2, 1})), at(0, 0, 0), 4.0);
  const double more = 1.0 + 1e-9;
  expect_depth(made(ellipsoid({1, 1, more})), made(ellipsoid({more, 1, more})), at(0, 0, 0), 2.0);
}

TEST(SymmetricDepth, OfShallowEllipsoidsTakesNoCoverOfTheSphere) {
  const ConvexBody a = made(ellipsoid({1.0, 1.25, 1.5})), b = made(ellipsoid({1.5, 1, 1}));
  const DistanceResult r = test::cold(a, b, relative_pose(at(0, 0, 0), at(2.25, 0, 0)));
  EXPECT_NEAR(r.distance, -0.25, 1e-15);
  EXPECT_LE(r.upper - r.lower, 1e-13 * 5.0);
  EXPECT_LT(r.iterations, 40);
}

// The second body is beside the axis of the first one and tilted. Oracle: the overlap along the
// best direction that a search finds, which is never below the depth.
TEST(SymmetricDepth, OfSolidsBesideOneAxisIsNoMoreThanAnOverlap) {
  Random random(43);
  int known = 0, tight = 0;
  const auto solid = [&] {
    const auto extent = [&] { return random.uniform(0.2, 1.0); };
    if (random.chance(0.3)) return made(cylinder(extent(), extent()));
    return made(truncated_cone(extent(), extent(), extent()));
  };
  for (int k = 0; k < 400; ++k) {
    const ConvexBody a = solid(), b = solid();
    const bool is_tilted = random.chance(0.5);
    const double aside = is_tilted ? 0.0 : random.log_uniform(1e-6, 0.2);
    const double tilt = is_tilted ? random.log_uniform(1e-6, 0.3) : 0.0;
    Vec3 across = random.direction();
    across = Vec3(across.x(), across.y(), 0.0).normalized();
    const Pose place{Vec3(0, 0, random.uniform(-0.5, 0.5)) + aside * across,
                     test::turned(across, tilt)};
    const RelativePose b_in_a = relative_pose(Pose{}, place);
    CurvedPair pair(a, b, b_in_a);
    const double least = least_symmetric_depth(pair, kInfinity);
    if (!(least > 0.0)) continue;
    ++known;
    (void)pair.support(random.direction());
    (void)bound_depth(pair, {});
    const double overlap = -pair.bounds.lower;
    EXPECT_LE(least, overlap + 1e-13 * pair.size) << k << ": " << aside << " m, " << tilt;
    tight += least > overlap - 1e-3 * pair.size;
  }
  EXPECT_GT(known, 200);
  EXPECT_GT(tight, 100);
}

}  // namespace
}  // namespace clearance
