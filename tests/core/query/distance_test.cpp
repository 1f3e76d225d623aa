// distance() in closed form: answers that a person can check.
#include "core/distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <variant>

#include "core/numerics/error_constants.hpp"
#include "core/shapes.hpp"
#include "tests/shared/exact_body.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using test::at;
using test::cold;
using test::cube;
using test::half_space;
using test::made;
using test::turned;

// The rounding error of numbers of about one.
constexpr double kRounding = 1e-14;

ConvexBody ball(double radius) { return made(point(Vec3::Zero(), radius)); }
ConvexBody capsule(double half_length, double radius) {
  return made(segment({0, 0, -half_length}, {0, 0, half_length}, radius));
}
// A prism along z whose sides satisfy normal . x = 0.5.
ConvexBody unbounded_prism(std::initializer_list<Vec3> normals) {
  std::vector<HalfSpace> rows;
  for (const Vec3& n : normals) rows.push_back({n, 0.5});
  return made(polyhedron_from_halfspaces(rows));
}

// `size` is the largest number involved, which rounding is relative to.
void expect_distance(const DistanceResult& r, double truth, double size = 1.0) {
  EXPECT_NEAR(r.distance, truth, kRounding * size);
  EXPECT_LE(r.lower, truth);
  EXPECT_GE(r.upper, truth);
  EXPECT_LE(r.upper - r.lower, 4 * kRounding * size);
}

void expect_near(const Vec3& found, const Vec3& expected) {
  EXPECT_LT((found - expected).norm(), kRounding) << found.transpose();
}

TEST(Distance, OfCubesFaceToFaceIsTheGap) {
  const DistanceResult r = cold(cube(), cube(), at(1.5, 0.25, 0));
  expect_distance(r, 0.5);
  EXPECT_EQ(r.status, DistanceStatus::kConverged);
  expect_near(r.normal, Vec3::UnitX());
  expect_near(r.point_on_b - r.point_on_a, {0.5, 0, 0});
}

TEST(Distance, OfCubesEdgeToEdgeAndCornerToCornerIsTheDiagonal) {
  expect_distance(cold(cube(), cube(), at(4, 5, 0.5)), 5.0);
  const DistanceResult r = cold(cube(), cube(), at(2, 3, 3));
  expect_distance(r, 3.0);
  expect_near(r.point_on_a, {0.5, 0.5, 0.5});
  expect_near(r.point_on_b, {1.5, 2.5, 2.5});
  expect_near(r.normal, Vec3(1, 2, 2) / 3.0);
}

TEST(Distance, OfCrossingEdgesIsAlongTheirCommonNormal) {
  // Both cubes are rotated by 45 degrees: an edge along y and an edge along x face each other on
  // the z axis.
  const double half_diagonal = std::numbers::sqrt2 / 2;
  TrackingState state;
  const Pose pose_a = Pose{{0, 0, 0}, turned(Vec3::UnitY(), std::numbers::pi / 4)};
  const Pose pose_b = Pose{{0.1, 0.2, 3}, turned(Vec3::UnitX(), std::numbers::pi / 4)};
  const DistanceResult r = distance(cube(), cube(), relative_pose(pose_a, pose_b), state);
  expect_distance(r, 3 - 2 * half_diagonal);
  EXPECT_EQ(state.a.kind, FeatureKind::kEdge);
  EXPECT_EQ(state.b.kind, FeatureKind::kEdge);
}

TEST(Distance, OfTouchingCubesIsZeroAndSaysTouching) {
  for (const Pose& pose : {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0.3, 1)}) {
    const DistanceResult r = cold(cube(), cube(), pose);
    expect_distance(r, 0.0);
    EXPECT_EQ(r.status, DistanceStatus::kTouching);
    EXPECT_LE(r.lower, 0.0);
  }
}

TEST(Distance, OfSpheresIsThatOfTheCentresLessTheRadii) {
  const DistanceResult r = cold(ball(0.5), ball(0.25), at(3, 4, 0));
  expect_distance(r, 4.25);
  expect_near(r.point_on_a, {0.3, 0.4, 0});
  expect_near(r.normal, {0.6, 0.8, 0});
}

TEST(Distance, OfOverlappingSpheresIsMinusTheDepth) {
  const DistanceResult r = cold(ball(0.5), ball(0.5), at(0.75, 0, 0));
  expect_distance(r, -0.25);
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
}

TEST(Distance, OfSpheresWithOneCentreIsMinusBothRadii) {
  const DistanceResult r = cold(ball(0.5), ball(0.25), at(0, 0, 0));
  expect_distance(r, -0.75);
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
}

TEST(Distance, OfCapsulesParallelCrossedAndEndToEnd) {
  const ConvexBody a = capsule(1.0, 0.25);
  expect_distance(cold(a, a, at(1, 0, 0.5)), 0.5);
  expect_distance(cold(a, a, Pose{{1, 0, 0}, turned(Vec3::UnitX(), std::numbers::pi / 2)}), 0.5);
  expect_distance(cold(a, a, at(0, 0, 3)), 0.5);
  expect_distance(cold(a, a, at(3, 0, 6)), 4.5);
}

TEST(Distance, OfASphereAndABoxIsMeasuredFromTheCore) {
  expect_distance(cold(cube(), ball(0.25), at(2, 0, 0)), 1.25);
  expect_distance(cold(cube(), ball(0.25), at(3.5, 4.5, 0)), 4.75);
  expect_distance(cold(cube(), ball(0.25), at(0.6, 0, 0)), 0.1 - 0.25);
  const DistanceResult inside = cold(cube(), ball(0.25), at(0.1, 0, 0));
  expect_distance(inside, -0.4 - 0.25);
  EXPECT_EQ(inside.status, DistanceStatus::kOverlapping);
}

TEST(Distance, OfABoxAboveAFloorIsItsLowestPoint) {
  const ConvexBody floor = half_space({0, 0, 1}, 0.0);
  expect_distance(cold(floor, cube(), at(100, -100, 2)), 1.5, 200);
  const DistanceResult corner =
      cold(floor, cube(), Pose{{0, 0, 2}, turned({1, -1, 0}, std::acos(1 / std::sqrt(3.0)))});
  expect_distance(corner, 2 - std::sqrt(3.0) / 2);
  expect_near(corner.normal, Vec3::UnitZ());
  EXPECT_EQ(cold(floor, cube(), at(0, 0, 0.4)).status, DistanceStatus::kOverlapping);
  EXPECT_EQ(cold(floor, cube(), at(0, 0, -1e6)).status, DistanceStatus::kOverlapping);
}

TEST(Distance, OfTwoUnboundedBodiesIsBoundedFromBelowWhereRoundingCanTell) {
  const ConvexBody floor = half_space({0, 0, 1}, 0.0);
  const ConvexBody corner =
      made({{{{1, 0, 1}, 0.0}, {{-1, 0, 1}, 0.0}, {{0, 1, 1}, 0.0}, {{0, -1, 1}, 0.0}}, {}, 0.0});
  const Pose upside_down{{0.5, 0.25, 2}, turned(Vec3::UnitX(), std::numbers::pi)};
  expect_distance(cold(floor, corner, upside_down), 2.0, 20);
  expect_distance(cold(corner, floor, upside_down), 2.0, 20);
  expect_distance(cold(corner, corner, upside_down), std::sqrt(4.3125), 30);
  // A tilt by the last bit would make the planes meet, but far away.
  for (const double tilt : {0.0, 0x1p-52}) {
    const DistanceResult parallel = cold(floor, half_space({tilt, 0, -1}, -2.0), at(0, 0, 0));
    EXPECT_EQ(parallel.lower, -kInfinity);
    EXPECT_LE(parallel.upper, 2.0 + kRounding);
    EXPECT_EQ(parallel.status, DistanceStatus::kIterationLimit);
  }
}

TEST(Distance, MeansTheExactNormalisationOfQuaternions) {
  const Pose pose_a = Pose{{1, 2, 3}, turned({1, 2, 2}, 0.3)},
             pose_b = Pose{{4, 2, 2}, turned({0, 1, 3}, 1.2)};
  TrackingState state;
  const double expected = distance(cube(), cube(), pose_a, pose_b, state).distance;
  for (const double length : {1.0 - 9.9e-7, 1.0 - 1e-9, 1.0 + 1e-8, 1.0 + 9.9e-7}) {
    for (const double other : {length, 1.0, 1.0 / length}) {
      Pose long_a = pose_a, long_b = pose_b;
      long_a.orientation.coeffs() *= length;
      long_b.orientation.coeffs() *= other;
      TrackingState fresh;
      const DistanceResult r = distance(cube(), cube(), long_a, long_b, fresh);
      EXPECT_NEAR(r.distance, expected, 10 * kRounding);
      EXPECT_LE(r.upper - r.lower, 20 * kRounding);
      EXPECT_LT((transform(long_b, Vec3(1, 2, 3)) - transform(pose_b, Vec3(1, 2, 3))).norm(),
                1e-14);
    }
  }
}

// The third orientation is the first one's inverse: only the sign of w differs.
TEST(Distance, ByTwoPosesHasAnExactRotationOnlyWhereBothAreTurnedAlike) {
  const Eigen::Quaterniond turn = turned(Vec3::UnitX(), 0.3);
  const Pose a{{1, 2, 3}, turn};
  for (const auto& [sign_of_x, sign_of_w, is_exact] :
       {std::tuple{1.0, 1.0, true}, {-1.0, -1.0, true}, {1.0, -1.0, false}, {-1.0, 1.0, false}}) {
    Pose b{{4, 2, 2}, turn};
    b.orientation.x() *= sign_of_x;
    b.orientation.w() *= sign_of_w;
    EXPECT_EQ(relative_pose(a, b).rotation_error == 0.0, is_exact) << sign_of_x << sign_of_w;
  }
  for (const double angle : {1e-8, 1e-11, 1e-14})
    EXPECT_GT(relative_pose(a, {{}, turned(Vec3::UnitX(), 0.3 + angle)}).rotation_error, 0.0);
}

TEST(Distance, OfPointsIsEuclid) {
  const ConvexBody p = made(point({1, 2, 2}, 0.0)), q = made(point({1, 2, 2}, 0.0));
  const DistanceResult r = cold(p, q, at(2, 3, 6));
  expect_distance(r, 7.0, 10);
  expect_near(r.point_on_a, {1, 2, 2});
  expect_distance(cold(cube(), p, at(0, 0, 0)), std::sqrt(0.25 + 2 * 2.25));
}

// Squares of such lengths are zero in doubles.
TEST(Distance, HoldsWhereSquaresUnderflow) {
  const ConvexBody p = made(point(Vec3::Zero(), 0.0));
  for (const double apart : {1e-150, 1e-160, 1e-200, 1e-300}) {
    for (const DistanceResult& r :
         {cold(p, p, at(apart, 0, 0)), cold(cube(), cube(), at(0, 1, apart)),
          cold(half_space({0, 0, 1}, 0.0), p, at(0, 0, apart))}) {
      EXPECT_LE(r.lower, apart);
      EXPECT_GE(r.upper, r.lower);
    }
    EXPECT_GE(cold(p, p, at(apart, 0, 0)).upper, apart);
  }
}

// Starts from all kinds of features, and checks the answers and the states that they leave.
void expect_unknown(const ConvexBody& a, const ConvexBody& b, const Pose& pose) {
  static const ConvexBody sound = cube();
  for (std::uint8_t kinds = 0; kinds < 18; ++kinds) {
    TrackingState state{{static_cast<FeatureKind>(kinds % 3), kinds >= 9, 0},
                        {static_cast<FeatureKind>(kinds / 3 % 3), false, 0}};
    TrackingState other = state;
    for (const DistanceResult& r :
         {distance(a, b, Pose{}, pose, state), distance(a, b, relative_pose(pose, {}), other)}) {
      EXPECT_EQ(r.lower, -kInfinity);
      EXPECT_EQ(r.upper, kInfinity);
      for (const double x : {r.distance, r.normal.x(), r.normal.y(), r.normal.z(), r.point_on_a.x(),
                             r.point_on_a.y(), r.point_on_a.z(), r.point_on_b.x(), r.point_on_b.y(),
                             r.point_on_b.z()}) {
        EXPECT_TRUE(std::isnan(x));
      }
      EXPECT_EQ(r.status, DistanceStatus::kBadPose);
    }
    expect_distance(distance(sound, sound, Pose{}, at(1.5, 0.25, 0), state), 0.5);
  }
}

TEST(Distance, OfABadPoseHasInfiniteBoundsAndIsUnknown) {
  const ConvexBody bodies[] = {cube(), ball(0.5), capsule(1.0, 0.25), half_space({0, 0, 1}, 0.0),
                               unbounded_prism({{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}})};
  for (const ConvexBody& a : bodies) {
    for (const ConvexBody& b : bodies) {
      for (int k = 0; k < 7; ++k) {
        for (const double x : {std::nan(""), kInfinity, -kInfinity}) {
          Pose pose = at(3, 0.2, 0.1);
          (k < 3 ? pose.position[k] : pose.orientation.coeffs()[k - 3]) = x;
          expect_unknown(a, b, pose);
        }
      }
      for (const double length : {0.0, 0.5, 1.0 - 1.1e-6, 1.0 + 1.1e-6, 1e300}) {
        expect_unknown(a, b, {Vec3(3, 0.2, 0.1), {length, 0, 0, 0}});
      }
      expect_unknown(a, b, at(1.1e12, 0, 0));
    }
  }
}

TEST(Distance, HoldsFarAway) {
  for (const double far : {1e9, 1e11, 7e11}) {
    const DistanceResult r = cold(cube(), cube(), at(0, far, far));
    EXPECT_LE(r.lower, far * std::numbers::sqrt2);
    EXPECT_GE(r.upper, far);
    EXPECT_LE(r.lower, r.distance);
    EXPECT_LE(r.distance, r.upper);
  }
}

TEST(Distance, SaysWhichMethodHasAnswered) {
  const ConvexBody column = unbounded_prism({{1, 1, 0}, {-1, 1, 0}, {0, -1, 0}});
  TrackingState state;
  const auto path = [&](const ConvexBody& body, const Pose& pose) {
    return distance(body, body, relative_pose(Pose{}, pose), state).path;
  };
  EXPECT_EQ(path(cube(), at(1.5, 0.3, 0.2)), DistancePath::kFeatureTracking);
  EXPECT_EQ(path(cube(), at(0.95, 0.3, 0.2)), DistancePath::kPenetration);
  EXPECT_EQ(path(cube(), at(0.3, 0.2, 0.1)), DistancePath::kPenetration);
  state = {};
  EXPECT_EQ(path(cube(), at(0.3, 0.2, 0.1)), DistancePath::kPenetration) << "level";
  state = {};
  const Pose tilted{{0.3, 0.2, 0.1}, Eigen::Quaterniond(0.9, 0.1, 0.2, 0.3).normalized()};
  EXPECT_EQ(path(cube(), tilted), DistancePath::kActiveSet);
  const Pose leaning{{3, 1, 0}, {1.0, 1e-14, 0, 0}};
  EXPECT_EQ(path(column, leaning), DistancePath::kGjk);
}

// Every state that names features of both bodies.
std::vector<TrackingState> states_of(const ConvexBody& a, const ConvexBody& b) {
  const auto sides = [](const ConvexBody& body) {
    std::vector<TrackingState::Side> all;
    for (const FeatureKind kind : {FeatureKind::kVertex, FeatureKind::kEdge, FeatureKind::kFacet}) {
      for (std::uint32_t i = 0; i < body.features[static_cast<std::size_t>(kind)]; ++i) {
        all.push_back({kind, false, static_cast<std::int32_t>(i), body.interior});
      }
    }
    return all;
  };
  std::vector<TrackingState> states;
  for (const auto& on_a : sides(a)) {
    for (const auto& on_b : sides(b)) {
      for (const bool penetrating : {false, true}) {
        states.push_back({on_a, on_b});
        states.back().a.penetrating = penetrating;
      }
    }
  }
  return states;
}

TEST(Distance, OfTwoUnboundedBodiesIsLeftToTheSearchWhateverFeaturesTheStateNames) {
  const ConvexBody floor = half_space({0, 0, 1}, 0.0);
  const HalfSpace rows[] = {{{-1, 0, -0.1}, 0.0}, {{0, -1, -0.1}, 0.0}, {{1, 1, -0.3}, 0.0}};
  const ConvexBody corner = made(polyhedron_from_halfspaces(rows));
  const ConvexBody column = unbounded_prism({{1, 1, 0}, {-1, 1, 0}, {0, -1, 0}});
  const struct {
    const ConvexBody &a, &b;
    Pose a_from_b;
    double truth;
  } cases[] = {{floor, corner, at(0.3, 0.2, 2.0), 2.0},
               {corner, floor, at(0.3, 0.2, -2.0), 2.0},
               {column, column, at(0, 3.0, 0), 2.0}};
  for (const auto& [a, b, a_from_b, truth] : cases) {
    for (TrackingState& state : states_of(a, b)) {
      const DistanceResult r = distance(a, b, relative_pose(Pose{}, a_from_b), state);
      EXPECT_TRUE(r.path == DistancePath::kActiveSet || r.path == DistancePath::kGjk);
      EXPECT_LE(r.lower, truth);
      EXPECT_GE(r.upper, truth);
    }
  }
}

TEST(Distance, NamesEveryStatus) {
  EXPECT_STREQ(name(DistanceStatus::kConverged), "converged");
  EXPECT_STREQ(name(DistanceStatus::kTouching), "touching");
  EXPECT_STREQ(name(DistanceStatus::kOverlapping), "overlapping");
  EXPECT_STREQ(name(DistanceStatus::kIterationLimit), "iteration_limit");
  EXPECT_STREQ(name(DistanceStatus::kDepthNotAsked), "depth_not_asked");
  EXPECT_STREQ(name(DistanceStatus::kBadPose), "bad_pose");
}

}  // namespace
}  // namespace clearance
