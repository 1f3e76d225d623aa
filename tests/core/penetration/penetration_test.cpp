// Signed distance of overlapping bodies: closed forms, the exact oracle, laws, and motions through
// contact.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/shared/allocation_count.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/exact_depth.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/tied_cases.hpp"

namespace clearance {
namespace {

using test::at;
using test::cold;
using test::cube;
using test::made;

using oracle::Body;

Body below_plane(const Vec3& normal, double offset) { return {{{normal, offset}}, {}, 0.0}; }

void expect_depth(const DistanceResult& r, double depth, double size = 1.0) {
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
  EXPECT_NEAR(r.distance, -depth, 1e-14 * size);
  EXPECT_LE(r.lower, -depth);
  EXPECT_GE(r.upper, -depth);
  EXPECT_LE(r.upper - r.lower, 4e-14 * size);
  EXPECT_NEAR(r.normal.norm(), 1.0, 1e-15);
  EXPECT_LT((r.point_on_b - r.point_on_a - r.distance * r.normal).norm(), 1e-14 * size);
}

// Bodies whose interiors intersect, from the families of the hard cases.
struct Overlap {
  Body a, b;
  Pose pose_a, pose_b;
};

Body small_body(Random& random) {
  switch (random.integer(0, 5)) {
    case 0:
      return hard::box(Vec3::Constant(0.05) + random.in_box(1.0).cwiseAbs());
    case 1:
      return hard::random_polytope(random, 8);
    case 2:
      return hard::random_hull(random, 7);
    case 3:
      return hard::needle(random, random.log_uniform(1.0, 1e4));
    case 4:
      return hard::plate(random, random.log_uniform(1e-6, 1.0));
    default:
      return hard::lattice(random);
  }
}

Overlap random_overlap(Random& random) {
  Overlap out{small_body(random), small_body(random), {}, {}};
  out.pose_a = {random.in_box(1.0), random.rotation()};
  out.pose_b = {out.pose_a.position + random.in_box(random.log_uniform(1e-4, 0.4)),
                random.chance(0.3) ? out.pose_a.orientation : random.rotation()};
  return out;
}

void for_each_overlap(std::uint64_t seeds, const std::function<void(Overlap&, Random&)>& visit) {
  for (std::uint64_t seed = 0; seed < repeats(seeds); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Overlap overlap = random_overlap(random);
    visit(overlap, random);
  }
}

TEST(Penetration, OfCubesIsTheShortestPathOutOfAFace) {
  expect_depth(cold(cube(), cube(), at(0.9, 0, 0)), 0.1);
  expect_depth(cold(cube(), cube(), at(0.5, 0.5, 0.5)), 0.5);
  expect_depth(cold(cube(), cube(), at(0, 0, 0.999999)), 1 - 0.999999);
  expect_depth(cold(cube(), cube(), at(0, 0, 0)), 1.0);
  const DistanceResult r = cold(cube(), cube(), at(0.25, -0.75, 0.5));
  expect_depth(r, 0.25);
  EXPECT_EQ(r.normal, Vec3(0, -1, 0));
  EXPECT_NEAR(r.point_on_a.y(), -0.5, 1e-15);
  EXPECT_NEAR(r.point_on_b.y(), -0.25, 1e-15);
}

TEST(Penetration, OfCrossingEdgesIsAcrossBoth) {
  // Two bars of square section. Each lies on an edge, and they cross at right angles.
  const ConvexBody bar = made(hard::box({0.5, 0.5, 10.0}));
  const double quarter = std::numbers::pi / 4;
  const Pose along_x{{0, 0, 0},
                     Eigen::Quaterniond(Eigen::AngleAxisd(2 * quarter, Vec3::UnitY()) *
                                        Eigen::AngleAxisd(quarter, Vec3::UnitZ()))};
  const Pose along_y{{0.3, 0.2, 1.3},
                     Eigen::Quaterniond(Eigen::AngleAxisd(-2 * quarter, Vec3::UnitX()) *
                                        Eigen::AngleAxisd(quarter, Vec3::UnitZ()))};
  TrackingState state;
  const RelativePose pose = relative_pose(along_x, along_y);
  const DistanceResult r = distance(bar, bar, pose, state);
  expect_depth(r, std::numbers::sqrt2 - 1.3, 20.0);
  EXPECT_EQ(state.a.kind, FeatureKind::kEdge);
  EXPECT_EQ(state.b.kind, FeatureKind::kEdge);
  const Vec3 in_world = along_x.orientation * r.normal;
  EXPECT_LT((in_world - Vec3::UnitZ()).norm(), 1e-14);
}

TEST(Penetration, KeepsItsDirectionWhereOthersAreAsDeep) {
  // Concentric balls of 64 facets: several directions have the same depth to the last bit.
  for (const std::uint64_t seed : {1900004, 25000004}) {
    Random random(seed);
    const hard::HardCase c = hard::nested(random);
    const DistanceJudge judge(c.a, c.b);
    TrackingState state;
    const Vec3 normal = judge.ask(c.pose_a, c.pose_b, state).normal;
    for (int k = 0; k < 6; ++k) {
      const DistanceResult r = judge.ask(c.pose_a, c.pose_b, state);
      EXPECT_LE((r.normal - normal).norm(), 1e-14) << "seed " << seed;
    }
  }
}

TEST(Penetration, OfASmallBodyInsideALargeOneIsThePathToTheNearestFace) {
  const ConvexBody room = made(hard::box({5, 5, 2})), ball = made({{}, {Vec3::Zero()}, 0.25});
  expect_depth(cold(room, cube(), at(1, 2, 0.5)), 2.0, 10);
  expect_depth(cold(room, ball, at(4.5, 2, 0)), 0.75, 10);
  expect_depth(cold(ball, room, at(-4.5, 2, 0)), 0.75, 10);
  const ConvexBody capsule = made({{}, {{0, 0, -1}, {0, 0, 1}}, 0.5});
  expect_depth(cold(room, capsule, at(0, 0, 0.5)), 2.0 - 0.5 + 1.0 + 0.5, 10);
  expect_depth(cold(capsule, room, at(4.8, 0, 0)), 0.2 + 0.5, 10);
}

TEST(Penetration, OfAFloorIsHowFarTheLowestPointIsBelowIt) {
  const ConvexBody floor = test::half_space({0, 0, 1}, 0.0);
  const DistanceResult r = cold(floor, cube(), at(3, 4, -2));
  expect_depth(r, 2.5, 10);
  EXPECT_EQ(r.normal, Vec3::UnitZ());
  EXPECT_EQ(cold(cube(), floor, at(0, 0, 0.25)).normal, -Vec3::UnitZ());
}

TEST(Penetration, OfTwoUnboundedBodiesIsUnknown) {
  ConvexBody floor = test::half_space({0, 0, 1}, 0.0);
  const ConvexBody wall = test::half_space({1, 0, 0}, 0.0);
  for (const double radius : {0.0, 0.25}) {
    floor.radius = radius;
    const DistanceResult r = cold(floor, wall, at(0, 0, 0));
    // If two polyhedra share a point, any positive radius makes the penetration certain.
    EXPECT_EQ(r.status,
              radius > 0.0 ? DistanceStatus::kOverlapping : DistanceStatus::kIterationLimit);
    EXPECT_EQ(r.lower, -kInfinity);
    EXPECT_GE(r.upper, r.distance);
    EXPECT_TRUE(r.normal.allFinite());
    EXPECT_TRUE(r.point_on_a.allFinite());
    EXPECT_TRUE(r.point_on_b.allFinite());
  }
}

TEST(Penetration, OfSegmentsThatCrossIsNothingButTheirRadii) {
  const ConvexBody a = made({{}, {{-1, 0, 0}, {1, 0, 0}}, 0.25});
  const ConvexBody b = made({{}, {{0, -1, 0}, {0, 1, 0}}, 0.5});
  expect_depth(cold(a, b, at(0, 0, 0)), 0.75);
}

TEST(ExactDepth, GivesTheClosedFormsOfCubes) {
  const Body box = hard::box(Vec3::Constant(0.5));
  EXPECT_EQ(oracle::exact_squared_depth(box, at(0, 0, 0), box, at(0.75, 0.25, 0)), 0.0625);
  EXPECT_EQ(oracle::exact_squared_depth(box, at(0, 0, 0), box, at(1, 0.25, 0)), 0);
  EXPECT_EQ(oracle::exact_squared_depth(box, at(0, 0, 0), box, at(2, 0, 0)), 0);
  EXPECT_EQ(oracle::exact_squared_depth(below_plane({0, 0, 3}, 0), at(0, 0, 0), box, at(9, 9, -1)),
            2.25);
  EXPECT_FALSE(oracle::exact_squared_depth(below_plane({0, 0, 1}, 0), at(0, 0, 0),
                                           below_plane({1, 0, 0}, 0), at(0, 0, 0)));
}

TEST(Penetration, HoldsAgainstTheExactTruthColdAndTrackedAndWithNonsense) {
  int overlapping = 0;
  for_each_overlap(150, [&](Overlap& o, Random& random) {
    DistanceJudge judge(o.a, o.b);
    ASSERT_EQ(judge.refusal(), "");
    const oracle::ExactDistance truth = judge.truth(o.pose_a, o.pose_b);
    overlapping += truth.squared_depth != 0;
    TrackingState state;
    for (int k = 0; k < 6; ++k) {
      for (const std::string& fault :
           judge.faults(judge.ask(o.pose_a, o.pose_b, state), truth, o.pose_a, o.pose_b)) {
        ADD_FAILURE() << (k == 0 ? "cold: " : k == 1 ? "tracked: " : "nonsense: ") << fault;
      }
      if (k == 0) continue;
      for (TrackingState::Side* side : {&state.a, &state.b}) {
        side->kind = static_cast<FeatureKind>(random.integer(0, 3));
        side->feature = random.integer(-1, 30);
        side->penetrating = random.chance(0.7);
        side->point = random.in_box(2.0);
        if (random.chance(0.2)) side->point.x() = std::nan("");
      }
    }
  });
  EXPECT_GT(overlapping, static_cast<int>(repeats(100)));
}

TEST(Penetration, SwappingTheBodiesTurnsTheNormal) {
  for_each_overlap(100, [](Overlap& o, Random&) {
    const ConvexBody a = made(o.a), b = made(o.b);
    const DistanceResult r = cold(a, b, relative_pose(o.pose_a, o.pose_b));
    const DistanceResult s = cold(b, a, relative_pose(o.pose_b, o.pose_a));
    EXPECT_LE(r.lower, s.upper);
    EXPECT_LE(s.lower, r.upper);
    EXPECT_EQ(r.status, s.status);
  });
}

TEST(Penetration, MovingByItAlongTheNormalMakesTheBodiesTouch) {
  for_each_overlap(100, [](Overlap& o, Random&) {
    const ConvexBody a = made(o.a), b = made(o.b);
    RelativePose pose = relative_pose(o.pose_a, o.pose_b);
    const DistanceResult r = cold(a, b, pose);
    if (r.status != DistanceStatus::kOverlapping) return;
    pose.translation -= r.distance * r.normal;
    const double size = a.bounding_radius + b.bounding_radius + pose.translation.norm();
    EXPECT_NEAR(cold(a, b, pose).distance, 0.0, 1e-14 * size);
    pose.translation += r.normal;
    EXPECT_NEAR(cold(a, b, pose).distance, 1.0, 1e-14 * size);
  });
}

TEST(Penetration, ChangesByNoMoreThanTheBodiesMoveThroughContactToo) {
  for_each_overlap(20, [](Overlap& o, Random& random) {
    const ConvexBody a = made(o.a), b = made(o.b);
    const double reach = a.bounding_radius + b.bounding_radius;
    const int steps = 200;
    const Vec3 step = random.direction() * 4.0 * reach / steps;
    Pose pose_b = o.pose_b;
    pose_b.position -= 0.5 * steps * step;
    TrackingState state;
    DistanceResult before = distance(a, b, relative_pose(o.pose_a, pose_b), state);
    for (int k = 0; k < steps; ++k) {
      pose_b.position += step;
      const RelativePose pose = relative_pose(o.pose_a, pose_b);
      const DistanceResult now = distance(a, b, pose, state), fresh = cold(a, b, pose);
      EXPECT_LE(std::abs(now.distance - before.distance), step.norm() + 1e-13 * reach);
      EXPECT_LE(now.lower, fresh.upper);
      EXPECT_LE(fresh.lower, now.upper);
      EXPECT_NEAR(now.distance, fresh.distance, 2e-14 * 8 * reach);
      EXPECT_EQ(now.status == DistanceStatus::kOverlapping, now.upper < 0.0);
      before = now;
    }
  });
}

TEST(Penetration, AllocatesNothingAndGivesTheSameBits) {
  for_each_overlap(20, [](Overlap& o, Random&) {
    const ConvexBody a = made(o.a), b = made(o.b);
    const RelativePose pose = relative_pose(o.pose_a, o.pose_b);
    TrackingState state, again;
    const std::uint64_t before = allocations();
    const DistanceResult first = distance(a, b, pose, state), second = distance(a, b, pose, again);
    (void)distance(a, b, pose, state);
    EXPECT_EQ(allocations(), before);
    EXPECT_EQ(first.lower, second.lower);
    EXPECT_EQ(first.upper, second.upper);
    EXPECT_EQ(first.point_on_b, second.point_on_b);
  });
}

TEST(Penetration, WhereNobodyAsksForTheDepthTheBoundsHoldAndApartNothingChanges) {
  Random random(77);
  int overlapping = 0, apart = 0;
  for (int i = 0; i < 500; ++i) {
    const ConvexBody a = made(small_body(random)), b = made(small_body(random));
    const RelativePose pose = relative_pose(Pose{}, {random.in_box(1.0), random.rotation()});
    const DistanceResult whole = cold(a, b, pose);
    // A state that a query with the depth has left is also no more than a hint.
    for (const bool tracked : {false, true}) {
      TrackingState state;
      if (tracked) (void)distance(a, b, pose, state);
      const DistanceResult r = distance(a, b, pose, state, {.depth = false});
      ASSERT_LE(r.lower, whole.upper) << "case " << i;
      ASSERT_GE(r.upper, whole.lower) << "case " << i;
      if (whole.status == DistanceStatus::kOverlapping) {
        ASSERT_EQ(r.status, DistanceStatus::kDepthNotAsked) << "case " << i;
        ASSERT_FALSE(r.lower > 0.0);
        ++overlapping;
      } else if (whole.status == DistanceStatus::kConverged && !tracked) {
        ASSERT_EQ(r.status, whole.status) << "case " << i;
        ASSERT_EQ(r.lower, whole.lower);
        ASSERT_EQ(r.upper, whole.upper);
        ++apart;
      }
    }
  }
  EXPECT_GT(overlapping, 100);
  EXPECT_GT(apart, 100);
}

}  // namespace
}  // namespace clearance
