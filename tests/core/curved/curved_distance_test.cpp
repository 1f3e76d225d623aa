// Distances of curved bodies compared with closed forms, with published figures, and with the
// polyhedral query, which proves its answers differently. Other tests cover the interfaces that
// users meet: states, options, batches and models around bodies.
#include "core/curved/curved_distance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/batch.hpp"
#include "core/distance.hpp"
#include "core/enclosing_polyhedron.hpp"
#include "core/model/curved_extent.hpp"
#include "core/shapes.hpp"
#include "tests/shared/allocation_count.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/nonsense_state.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

using test::at;
using test::cold;
using test::made;

constexpr double kHalfTurn = std::numbers::pi;

DistanceResult answer(const ConvexBody& a, const ConvexBody& b, const Pose& world_from_a,
                      const Pose& world_from_b) {
  return test::cold(a, b, relative_pose(world_from_a, world_from_b));
}

Pose turned_at(double x, double y, double z, const Vec3& axis, double angle) {
  return {{x, y, z}, test::turned(axis, angle)};
}

// The bounds contain the exact answer and are as close to each other as promised.
void expect_answer(const DistanceResult& r, double exact, double size, double rounding = 0.0) {
  EXPECT_LE(r.lower, exact + rounding);
  EXPECT_GE(r.upper, exact - rounding);
  EXPECT_LE(r.upper - r.lower, 1e-13 * size);
  EXPECT_NEAR(r.distance, exact, 1e-14 * size);
}

TEST(CurvedDistance, OfTheThesissCrossedEllipsoidsIsTheKnownOne) {
  // (5.2.2) gives the points to 1e-11. The distance is 1.29549481993874080913966969921.
  const ConvexBody a = made(ellipsoid({1, 2, 5})), b = made(ellipsoid({5, 2, 1}));
  const DistanceResult r = answer(a, b, at(0, 0, 0), at(4, 4, 4));
  expect_answer(r, 1.29549481993874080914, 10.0 + 6.9);
  EXPECT_NEAR(r.point_on_a.x(), 0.13705777781256, 1e-10);
  EXPECT_NEAR(r.point_on_a.y(), 1.43051641611194, 1e-10);
  EXPECT_NEAR(r.point_on_a.z(), 3.42644444486425, 1e-10);
  EXPECT_EQ(r.status, DistanceStatus::kConverged);
}

TEST(CurvedDistance, OfSpheresHoweverMadeIsThatOfTheirCentresLessTheRadii) {
  const ConvexBody point = made(clearance::point({0, 0, 0}, 0.75));
  const ConvexBody round[] = {made(ellipsoid({0.75, 0.75, 0.75})), point,
                              made(ellipsoid({0.5, 0.5, 0.5}, 0.25))};
  for (const ConvexBody& a : round) {
    for (const ConvexBody& b : round) {
      expect_answer(answer(a, b, at(0, 0, 0), at(3, 4, 0)), 3.5, 6.5);
      expect_answer(answer(a, b, at(0, 0, 0), at(0.75, 0, 0)), -0.75, 2.25);
    }
  }
}

TEST(CurvedDistance, OfCylindersIsThatOfCapsSidesAndRims) {
  const ConvexBody a = made(cylinder(1.0, 2.0)), b = made(cylinder(0.5, 1.0));
  expect_answer(answer(a, b, at(0, 0, 0), at(0, 0, 4)), 1.0, 8.0);  // coaxial
  // half of each cap over the other
  expect_answer(answer(a, b, at(0, 0, 0), at(1.25, 0, 4)), 1.0, 8.0);
  expect_answer(answer(a, b, at(0, 0, 0), at(3, 0, 0.5)), 1.5, 8.0);  // side by side
  // rim to rim, offsets 3 m and 4 m
  expect_answer(answer(a, b, at(0, 0, 0), at(4.5, 0, 7)), 5.0, 15.0);
  const Pose crossed = turned_at(3, 0, 0, Vec3::UnitX(), kHalfTurn / 2);
  expect_answer(answer(a, b, at(0, 0, 0), crossed), 1.5, 8.0, 1e-16);
}

TEST(CurvedDistance, OfConesIsThatOfApexBaseAndSide) {
  const ConvexBody cone_a = made(cone(1.0, 1.0)), sphere = made(ellipsoid({1, 1, 1}));
  expect_answer(answer(cone_a, sphere, at(0, 0, 0), at(0, 0, 4)), 2.0, 8.0);
  expect_answer(answer(cone_a, sphere, at(0, 0, 0), at(0, 0, -4)), 2.0, 8.0);
  // The side runs from (1, -1) to (0, 1). Its outward normal is (2, 1) / sqrt 5.
  const double side = (2.0 * 3.0 + 1.0 * 1.5 - 1.0) / std::sqrt(5.0) - 1.0;
  expect_answer(answer(cone_a, sphere, at(0, 0, 0), at(3, 0, 1.5)), side, 8.0);
}

TEST(CurvedDistance, OfAHalfSpaceIsThatOfOneSupportPoint) {
  const HalfSpace rows[] = {{{0, 0, 1}, 0.0}};
  const ConvexBody floor = made(polyhedron_from_halfspaces(rows));
  const ConvexBody ground = floor, body = made(ellipsoid({3, 2, 1}));
  expect_answer(answer(ground, body, at(0, 0, 0), at(5, 6, 4)), 3.0, 12.0);
  expect_answer(answer(body, ground, at(5, 6, 4), at(0, 0, 0)), 3.0, 12.0);
  expect_answer(answer(ground, body, at(0, 0, 0), at(5, 6, 0.25)), -0.75, 12.0);
}

TEST(CurvedDistance, OfParallelCapsTiltedByLittleIsThatOfTheLowerRim) {
  const ConvexBody a = made(cylinder(1.0, 1.0)), b = made(cylinder(0.5, 1.0));
  for (double tilt = 1e-14; tilt < 1e-2; tilt *= 10.0) {
    const Pose pose = turned_at(0, 0, 3, Vec3::UnitY(), tilt);
    const double exact = 3.0 - std::cos(tilt) - 0.5 * std::sin(tilt) - 1.0;
    expect_answer(answer(a, b, at(0, 0, 0), pose), exact, 6.0, 4e-16);
  }
}

TEST(CurvedDistance, OfDiscsAndNeedlesIsRightAlongTheirAxes) {
  const ConvexBody disc = made(ellipsoid({1, 1, 1e-4}));
  const ConvexBody needle = made(ellipsoid({1e-4, 1e-4, 1}));
  expect_answer(answer(disc, needle, at(0, 0, 0), at(0, 0, 2)), 1.0 - 1e-4, 5.0);
  expect_answer(answer(disc, disc, at(0, 0, 0), at(0, 0, 1)), 1.0 - 2e-4, 4.0);
  expect_answer(answer(needle, needle, at(0, 0, 0), at(1, 0, 0)), 1.0 - 2e-4, 4.0);
}

TEST(CurvedDistance, OfBodiesThatOverlapIsMinusTheShortestPathOut) {
  const ConvexBody a = made(cylinder(1.0, 3.0)), b = made(ellipsoid({0.5, 0.5, 2}));
  // The sideways translation, 1.5 - 1 = 0.5, is shorter than the lengthwise one, 5.
  expect_answer(answer(a, b, at(0, 0, 0), at(1, 0, 0)), -0.5, 7.0);
  const DistanceResult r = answer(a, b, at(0, 0, 0), at(0, 0, 4.75));
  expect_answer(r, -0.25, 10.0);
  EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
  EXPECT_NEAR(r.normal.z(), 1.0, 1e-7);
}

TEST(CurvedDistance, OfEllipsoidsWithOneCentreIsTheSumOfTheirShortestSemiAxes) {
  const ConvexBody a = made(ellipsoid({1, 2, 5})), b = made(ellipsoid({1.5, 2, 3}));
  expect_answer(answer(a, b, at(0, 0, 0), at(0, 0, 0)), -2.5, 8.0);
}

TEST(CurvedDistance, OfPolyhedraEnclosesWhatThePolyhedralQueryEncloses) {
  Random random(21);
  for (int k = 0; k < 400; ++k) {
    const ConvexBody p = made(box({random.log_uniform(0.1, 1), 0.5, 1}));
    const ConvexBody q = made(box({1, random.log_uniform(0.1, 1), 0.25}));
    const RelativePose pose = relative_pose(random.pose(1.5), random.pose(1.5));
    TrackingState state;
    TrackingState curved;
    const DistanceResult r = distance(p, q, pose, state);
    const DistanceResult s = curved_distance(p, q, pose, curved);
    EXPECT_LE(r.lower, s.upper) << k;
    EXPECT_LE(s.lower, r.upper) << k;
    EXPECT_LE(s.upper - s.lower, 1e-13 * (p.bounding_radius + q.bounding_radius + 5.0)) << k;
  }
}

TEST(CurvedDistance, TakesAnyStateAndNoHeap) {
  const ConvexBody a = made(cylinder(1, 1)), b = made(ellipsoid({1, 2, 3}));
  const RelativePose pose = relative_pose(at(0, 0, 0), at(4, 1, 0));
  TrackingState empty;
  const DistanceResult r = curved_distance(a, b, pose, empty);
  TrackingState nonsense;
  nonsense.a = {FeatureKind::kDirection, false, 0x7a5a5a5a, Vec3(0, 0, -1)};
  nonsense.b = {FeatureKind::kDirection, false, -0x5a5a5a5a, Vec3::Zero()};
  const std::uint64_t before = allocations();
  const DistanceResult s = curved_distance(a, b, pose, nonsense);
  EXPECT_EQ(allocations(), before);
  EXPECT_LE(r.lower, s.upper);
  EXPECT_LE(s.lower, r.upper);
  EXPECT_EQ(s.status, DistanceStatus::kConverged);
}

TEST(CurvedDistance, OfABadPoseIsUnknown) {
  const ConvexBody a = made(cylinder(1, 1));
  Pose bad = at(0, 0, 0);
  bad.position.x() = std::nan("");
  const DistanceResult r = answer(a, a, at(0, 0, 0), bad);
  EXPECT_EQ(r.status, DistanceStatus::kBadPose);
  EXPECT_EQ(r.upper, kInfinity);
}

// One body of every kind.
std::vector<ConvexBody> every_kind() {
  const std::array<Vec3, 5> hull{Vec3(0, 0, 0.4), Vec3(0.3, 0, 0), Vec3(-0.2, 0.3, 0),
                                 Vec3(-0.2, -0.3, 0), Vec3(0, 0, -0.3)};
  return {made(ellipsoid({0.2, 0.3, 0.5})),
          made(ellipsoid({0.3, 0.3, 0.01}, 0.05)),
          made(cylinder(0.2, 0.4)),
          made(cylinder(0.3, 0.01, 0.1)),
          made(cone(0.3, 0.3)),
          made(truncated_cone(0.3, 0.1, 0.2, 0.05)),
          made(box({0.2, 0.3, 0.1})),
          made(rounded_by(0.1, made(box({0.2, 0.3, 0.1})))),
          made(rounded_by(0.05, made(polyhedron_from_vertices(hull)))),
          made(point({0.1, 0, 0}, 0.2)),
          made(segment({0, 0, -0.2}, {0, 0.1, 0.2}, 0.1))};
}

TEST(CurvedBodies, MeetEveryOtherKindByPosesAndByRelativePoseAlike) {
  const std::vector<ConvexBody> bodies = every_kind();
  Random random(31);
  for (const ConvexBody& a : bodies) {
    for (const ConvexBody& b : bodies) {
      TrackingState by_poses, by_relative;
      for (int step = 0; step < 6; ++step) {
        const Pose world_from_a = random.pose(0.8), world_from_b = random.pose(0.8);
        const DistanceResult r = distance(a, b, world_from_a, world_from_b, by_poses);
        const DistanceResult s =
            distance(a, b, relative_pose(world_from_a, world_from_b), by_relative);
        EXPECT_TRUE(same_bits(r, s));
        EXPECT_LE(r.lower, r.upper);
        EXPECT_LE(r.upper - r.lower, 1e-13 * 4.0) << name(r.status);
      }
    }
  }
}

TEST(CurvedBodies, HaveTheSameBitsWithEveryVectorWidth) {
  const std::vector<ConvexBody> bodies = every_kind();
  const auto answers = [&](std::int64_t width) {
    const OnlyWith only(width);
    Random random(36);
    std::vector<DistanceResult> all;
    for (const ConvexBody& a : bodies) {
      for (const ConvexBody& b : bodies) {
        if (!a.is_curved() && !b.is_curved()) continue;
        TrackingState state;
        Pose pose = random.pose(0.6);
        pose.position += random.direction();
        for (int step = 0; step < 6; ++step) {
          pose.position += 0.02 * random.direction();
          all.push_back(distance(a, b, relative_pose(Pose{}, pose), state));
        }
      }
    }
    return all;
  };
  const std::vector<std::int64_t> widths = vector_widths();
  const std::vector<DistanceResult> first = answers(widths.front());
  for (const std::int64_t width : widths) {
    const std::vector<DistanceResult> others = answers(width);
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_TRUE(same_bits(first[i], others[i])) << i;
  }
}

TEST(CurvedBodies, HaveTheSameBitsInABatch) {
  const std::vector<ConvexBody> bodies = every_kind();
  std::vector<const ConvexBody*> shapes;
  std::vector<BodyPair> pairs;
  std::vector<Pose> poses;
  Random random(32);
  for (std::uint32_t b = 0; b < bodies.size(); ++b) {
    shapes.push_back(&bodies[b]);
    poses.push_back(random.pose(2.0));
    for (std::uint32_t a = 0; a < b; ++a) pairs.push_back({a, b});
  }
  DistanceBatch batch(shapes, pairs);
  std::vector<TrackingState> states(pairs.size());
  for (int step = 0; step < 40; ++step) {
    for (Pose& pose : poses) pose.position += 0.02 * random.direction();
    const std::uint64_t before = allocations();
    const auto found = batch.evaluate(poses);
    EXPECT_EQ(allocations(), before);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const auto [a, b] = pairs[i];
      const DistanceResult r = distance(bodies[a], bodies[b], poses[a], poses[b], states[i]);
      EXPECT_TRUE(same_bits(found[i], r)) << a << " " << b;
      EXPECT_EQ(batch.point_on_b(i), states[i].b.point);
    }
  }
}

TEST(CurvedBodies, KeepTheirBoundsWithStatesOfOtherPairs) {
  const std::vector<ConvexBody> bodies = every_kind();
  Random random(33);
  for (int k = 0; k < 2000; ++k) {
    const ConvexBody& a = bodies[random.integer(0, 5)];
    const ConvexBody& b = bodies[random.integer(0, static_cast<int>(bodies.size()) - 1)];
    const Pose pose = random.pose(1.0);
    const DistanceResult fresh = cold(a, b, pose);
    TrackingState state = test::nonsense_state(a, b, random);
    if (random.chance(0.5)) {
      state.a.kind = FeatureKind::kDirection;
      state.a.point = random.direction();
    }
    const DistanceResult r = distance(a, b, Pose{}, pose, state);
    EXPECT_LE(r.lower, fresh.upper) << k;
    EXPECT_GE(r.upper, fresh.lower) << k;
  }
}

TEST(CurvedBodies, AreNotAskedHowDeepTheyOverlapUnlessSomebodyAsks) {
  const ConvexBody a = made(cylinder(0.3, 0.4)), b = made(cone(0.5, 0.5));
  TrackingState state;
  const RelativePose pose = relative_pose(at(0, 0, 0), at(0.1, 0, 0.2));
  const DistanceResult r = distance(a, b, pose, state, {.depth = false});
  EXPECT_EQ(r.status, DistanceStatus::kDepthNotAsked);
  EXPECT_LT(r.iterations, 100);
  const DistanceResult s = distance(a, b, pose, state);
  EXPECT_EQ(s.status, DistanceStatus::kOverlapping);
  EXPECT_LE(r.lower, s.upper);
  EXPECT_LE(s.lower, r.upper);
  const DistanceResult t = distance(a, b, pose, state, {.depth = false});
  EXPECT_EQ(t.status, DistanceStatus::kDepthNotAsked);
  EXPECT_LE(t.lower, s.upper);
  EXPECT_LE(s.lower, t.upper);
}

// The unbounded bodies are compared with a box that is as long as doubles safely allow.
TEST(CurvedBodies, MeetUnboundedBodies) {
  const std::array<HalfSpace, 2> wedge_rows{HalfSpace{{1, 0, 0}, 0}, HalfSpace{{0, 1, 0}, 0}};
  const std::array<HalfSpace, 2> slab_rows{HalfSpace{{0, 0, 1}, 1}, HalfSpace{{0, 0, -1}, 1}};
  const std::array<HalfSpace, 3> corner_rows{HalfSpace{{1, 0, 1}, 0}, HalfSpace{{0, 1, 1}, 0},
                                             HalfSpace{{-1, -1, 1}, 0}};
  const ConvexBody wedge = made(polyhedron_from_halfspaces(wedge_rows));
  const ConvexBody slab = made(polyhedron_from_halfspaces(slab_rows));
  const ConvexBody corner = made(polyhedron_from_halfspaces(corner_rows));
  const ConvexBody ball = made(ellipsoid({1, 1, 1}));
  const auto expect = [](const DistanceResult& r, double exact) {
    EXPECT_NEAR(r.distance, exact, 1e-13);
    EXPECT_LE(r.lower, exact + 1e-15);
    EXPECT_GE(r.upper, exact - 1e-15);
    EXPECT_NE(r.status, DistanceStatus::kIterationLimit);
  };
  expect(cold(wedge, ball, at(4, 3, 7)), 4.0);   // edge is closest
  expect(cold(wedge, ball, at(-4, 3, 7)), 2.0);  // side is closest
  expect(cold(wedge, ball, at(-5, 0.5, -7)), -0.5);
  expect(cold(slab, ball, at(5, 6, 4)), 2.0);
  expect(cold(slab, ball, at(5, 6, 0.5)), -1.5);
  expect(cold(corner, ball, at(0, 0, 5)), 4.0);  // apex is closest
  expect(cold(ball, slab, at(5, 6, 4)), 2.0);
  expect(cold(ball, slab, at(5, 6, 0.5)), -1.5);
  const ConvexBody rod = made(cylinder(0.5, 2.0));
  expect(cold(wedge, rod, at(4, 3, 0)), 4.5);
  expect(cold(slab, rod, at(4, 3, 3.5)), 0.5);
}

TEST(CurvedBodies, AreInsideTheModelsAroundThem) {
  const std::vector<ConvexBody> bodies = every_kind();
  Random random(34);
  for (int k = 0; k < 20; ++k) {
    std::vector<PlacedShape> placed;
    for (int i = 0; i < 3; ++i) {
      placed.push_back({&bodies[random.integer(0, 5)], random.pose(0.5)});
    }
    const auto model = enclosing_polyhedron(placed);
    ASSERT_TRUE(model);
    for (const PlacedShape& body : placed) {
      for (int i = 0; i < 200; ++i) {
        const Vec3 n = random.direction();
        const Mat3 turn = rotation_matrix(body.frame_from_shape.orientation);
        const CurvedShape& shape = body.shape->curved;
        const double support = support_value(shape, turn.transpose() * n) + body.shape->radius +
                               n.dot(body.frame_from_shape.position);
        double of_model = -kInfinity;
        for (const Vec3& anchor : model->anchors) of_model = std::max(of_model, n.dot(anchor));
        EXPECT_LE(support, of_model + 1e-15);
      }
    }
  }
}

TEST(CurvedBodies, ReachNoFartherThanTheirExtents) {
  const std::vector<ConvexBody> bodies = every_kind();
  Random random(35);
  for (int k = 0; k < 500; ++k) {
    const CurvedShape& shape = bodies[random.integer(0, 5)].curved;
    const Vec3 from = random.in_box(2.0), n = random.direction(), to_middle = middle(shape);
    double farthest = 0.0;
    for (const Vec3& p : surface_points(shape, 24)) {
      EXPECT_LE(n.dot(p), support_value(shape, n) + 1e-15);
      EXPECT_LE((p - from).norm(), farthest_from(shape, from) + 1e-15);
      farthest = std::max(farthest, (p - to_middle).norm());
    }
    EXPECT_NEAR(farthest_from(shape, to_middle), farthest, 1e-14);
  }
}

TEST(CurvedBodies, AreRefusedWhereNoSceneHasThem) {
  const auto refused = [](const ShapeResult& made) {
    return std::holds_alternative<ShapeError>(made);
  };
  EXPECT_TRUE(refused(ellipsoid({1, 1, 0})));
  EXPECT_TRUE(refused(ellipsoid({1, std::nan(""), 1})));
  EXPECT_TRUE(refused(ellipsoid({1, 1e13, 1})));
  EXPECT_TRUE(refused(ellipsoid({1, 1, 1}, -1.0)));
  EXPECT_TRUE(refused(cylinder(0.0, 1.0)));
  EXPECT_TRUE(refused(cylinder(1.0, 0.0)));
  EXPECT_TRUE(refused(cone(1.0, kInfinity)));
  EXPECT_TRUE(refused(truncated_cone(0.0, 0.0, 1.0)));
  EXPECT_TRUE(refused(truncated_cone(1.0, -1.0, 1.0)));
  EXPECT_TRUE(refused(rounded_by(1e13, test::cube())));
  EXPECT_TRUE(refused(rounded_by(std::nan(""), test::cube())));
}

}  // namespace
}  // namespace clearance
