// Laws that must hold between answers about any curved bodies.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

using test::made;

constexpr int kExamples = 300;

struct Example {
  ConvexBody a, b;
  Pose world_from_a, world_from_b;

  [[nodiscard]] double size(const DistanceResult& r) const {
    return a.bounding_radius + a.radius + b.bounding_radius + b.radius +
           (world_from_a.position - world_from_b.position).norm() + std::abs(r.upper);
  }
};

// A random curved body or box, with all lengths multiplied by `scale`.
ConvexBody body_of(Random& random, double scale) {
  const auto length = [&] { return scale * random.log_uniform(0.05, 1.0); };
  const double x = length(), y = length(), z = length();
  const double radius = random.chance(0.3) ? 0.2 * length() : 0.0;
  switch (random.integer(0, 4)) {
    case 0:
      return made(ellipsoid({x, y, z}, radius));
    case 1:
      return made(cylinder(x, y, radius));
    case 2:
      return made(cone(x, y, radius));
    case 3:
      return made(truncated_cone(x, y, z, radius));
    default:
      return made(rounded_by(radius, made(box({x, y, z}))));
  }
}

Example example_of(std::uint64_t seed, double scale = 1.0) {
  Random random(seed);
  Example e;
  e.a = body_of(random, scale);
  e.b = body_of(random, scale);
  e.world_from_a = random.pose(2.0);
  e.world_from_b = random.pose(2.0);
  e.world_from_a.position *= scale;
  e.world_from_b.position *= scale;
  return e;
}

using test::cold;
DistanceResult answer(const Example& e) {
  return cold(e.a, e.b, relative_pose(e.world_from_a, e.world_from_b));
}

void expect_same_truth(const DistanceResult& r, const DistanceResult& s, double slack, int seed) {
  EXPECT_LE(r.lower, s.upper + slack) << "seed " << seed;
  EXPECT_LE(s.lower, r.upper + slack) << "seed " << seed;
}

TEST(CurvedLaws, AnswersConverge) {
  for (int seed = 0; seed < kExamples; ++seed) {
    const Example e = example_of(seed);
    const DistanceResult r = answer(e);
    EXPECT_LE(r.upper - r.lower, 1e-13 * e.size(r)) << "seed " << seed;
  }
}

TEST(CurvedLaws, SwappingTheBodiesSwapsTheAnswer) {
  for (int seed = 0; seed < kExamples; ++seed) {
    const Example e = example_of(seed);
    const DistanceResult s = cold(e.b, e.a, relative_pose(e.world_from_b, e.world_from_a));
    expect_same_truth(answer(e), s, 0.0, seed);
  }
}

TEST(CurvedLaws, MovingBothBodiesChangesNothing) {
  for (int seed = 0; seed < kExamples; ++seed) {
    const Example e = example_of(seed);
    Random random(seed + 1000);
    const Pose turn = random.pose(10.0);
    const RelativePose moved =
        relative_pose(compose(turn, e.world_from_a), compose(turn, e.world_from_b));
    const DistanceResult r = answer(e);
    expect_same_truth(r, cold(e.a, e.b, moved), 4.0 * kPlacingError * (e.size(r) + 30.0), seed);
  }
}

TEST(CurvedLaws, ScalingByAPowerOfTwoScalesTheBounds) {
  for (int seed = 0; seed < kExamples; ++seed) {
    const DistanceResult r = answer(example_of(seed)), s = answer(example_of(seed, 0x1p10));
    expect_same_truth(r, {.distance = 0.0, .lower = s.lower * 0x1p-10, .upper = s.upper * 0x1p-10},
                      0.0, seed);
  }
}

TEST(CurvedLaws, ALargerRadiusTakesItselfOff) {
  for (int seed = 0; seed < kExamples; ++seed) {
    Example e = example_of(seed);
    const DistanceResult r = answer(e);
    e.a.radius += 0.125;
    const DistanceResult s = answer(e);
    EXPECT_LE(r.lower - 0.125, s.upper) << "seed " << seed;
    EXPECT_LE(s.lower, r.upper - 0.125 + 1e-15) << "seed " << seed;
  }
}

TEST(CurvedLaws, MovedByTheDistanceTheyTouch) {
  for (int seed = 0; seed < kExamples; ++seed) {
    const Example e = example_of(seed);
    RelativePose pose = relative_pose(e.world_from_a, e.world_from_b);
    const DistanceResult r = cold(e.a, e.b, pose);
    if (!(r.lower > 0.0)) continue;
    pose.translation -= r.distance * r.normal;
    const DistanceResult s = cold(e.a, e.b, pose);
    // Two points of the bodies are no farther apart than this.
    const double apart = (r.point_on_b - r.point_on_a - r.distance * r.normal).norm();
    EXPECT_NEAR(s.distance, 0.0, apart + (r.upper - r.lower) + 1e-14 * e.size(r))
        << "seed " << seed;
  }
}

TEST(CurvedLaws, TheNormalJoinsTheClosestPointsToWhatTheBoundsAllow) {
  for (int seed = 0; seed < kExamples; ++seed) {
    const DistanceResult r = answer(example_of(seed));
    if (!(r.lower > 0.0)) continue;
    const Vec3 off = r.point_on_b - r.point_on_a - r.distance * r.normal;
    EXPECT_LE(off.norm(), std::sqrt((r.upper - r.lower) * (r.upper + r.lower))) << "seed " << seed;
  }
}

TEST(CurvedLaws, TheDeepestPointsAreAsFarApartAlongTheNormalAsTheBodiesAreDeep) {
  for (int seed = 0; seed < kExamples; ++seed) {
    const DistanceResult r = answer(example_of(seed));
    if (!(r.upper < 0.0)) continue;
    EXPECT_NEAR((r.point_on_b - r.point_on_a).dot(r.normal), r.distance, r.upper - r.lower)
        << "seed " << seed;
  }
}

TEST(CurvedLaws, TrackedIsTheSameTruthAsCold) {
  for (int seed = 0; seed < 60; ++seed) {
    Example e = example_of(seed);
    Random random(seed + 5000);
    const Vec3 step = 0.02 * random.direction();
    TrackingState state;
    for (int k = 0; k < 40; ++k) {
      e.world_from_b.position += step;
      const RelativePose pose = relative_pose(e.world_from_a, e.world_from_b);
      const DistanceResult tracked = distance(e.a, e.b, pose, state);
      expect_same_truth(cold(e.a, e.b, pose), tracked, 0.0, seed);
    }
  }
}

TEST(CurvedLaws, AnswersThatNeedNoSearchForADepthAreTheSameWithoutIt) {
  const std::array<HalfSpace, 2> slab_rows{HalfSpace{{0, 0, 1}, 1}, HalfSpace{{0, 0, -1}, 1}};
  const ConvexBody slab = made(polyhedron_from_halfspaces(slab_rows)),
                   floor = test::half_space({0, 0, 1}, 0.0), ball = made(ellipsoid({1, 1, 1})),
                   rod = made(cylinder(0.5, 2.0));
  const struct {
    const ConvexBody &a, &b;
    Pose pose_b;
    double distance;
  } cases[] = {{slab, ball, test::at(5, 6, 4), 2.0},
               {floor, ball, test::at(5, 6, 0.25), -0.75},
               {floor, rod, test::at(5, 6, 7), 5.0},
               {rod, ball, test::at(0, 2, 0), 0.5},
               {rod, rod, test::at(0, 0, 5), 1.0}};
  for (const auto& [a, b, pose_b, exact] : cases) {
    TrackingState with, without;
    const RelativePose pose = relative_pose(test::at(0, 0, 0), pose_b);
    const DistanceResult r = distance(a, b, pose, with),
                         s = distance(a, b, pose, without, {.depth = false});
    EXPECT_NEAR(r.distance, exact, 1e-14);
    EXPECT_EQ(r.status, exact < 0.0 ? DistanceStatus::kOverlapping : DistanceStatus::kConverged);
    EXPECT_TRUE(same_bits(r, s)) << exact;
  }
}

// As of a link whose place a chain of joints has rounded. Bounds widen by the error, and say the
// same as those of polyhedra: what converges, and what overlaps.
TEST(CurvedLaws, APlaceThatIsNotExactLeavesTheStatusAsItIs) {
  constexpr double kError = 1e-10;
  const ConvexBody can = made(cylinder(0.3, 1.0)), egg = made(ellipsoid({0.3, 0.4, 0.5}));
  const ConvexBody cube = test::cube(), floor = test::half_space({0, 0, 1}, 0.0);
  const ConvexBody ball = made(point(Vec3::Zero(), 0.2)), cone = made(clearance::cone(0.3, 1.0));
  int overlapping = 0;
  for (const ConvexBody* a : {&can, &egg, &cube, &floor, &ball, &cone}) {
    for (const ConvexBody* b : {&can, &egg, &cone}) {
      for (const Pose& pose :
           {test::at(0.1, 0.2, 2.5), Pose{{1.5, 0.3, 2.0}, test::turned({1, 2, 3}, 0.7)},
            test::at(0.05, 0.1, 0.2), Pose{{0.1, 0.05, 0.2}, test::turned({3, 2, 1}, 0.7)}}) {
        RelativePose place = relative_pose(Pose{}, pose);
        const DistanceResult exact = test::cold(*a, *b, place);
        place.translation_error += kError;
        TrackingState state;
        for (const bool again : {false, true}) {
          const DistanceResult r = distance(*a, *b, place, state);
          EXPECT_EQ(r.status, exact.status) << again;
          EXPECT_NE(r.status, DistanceStatus::kIterationLimit);
          EXPECT_LE(r.lower, exact.lower - kError * (1 - 1e-3));
          EXPECT_GE(r.upper, exact.upper + kError * (1 - 1e-3));
          overlapping += r.status == DistanceStatus::kOverlapping ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(overlapping, 20);
}

}  // namespace
}  // namespace clearance
