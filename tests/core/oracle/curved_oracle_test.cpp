// The oracle of curved bodies compared with independent results.
#include "tests/shared/curved_oracle.hpp"

#include <gtest/gtest.h>

#include "tests/shared/curved_cases.hpp"
#include "tests/shared/exact_oracle.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"

namespace clearance::oracle {
namespace {

TEST(CurvedOracle, KnowsTheThesissCrossedEllipsoidsTo27Digits) {
  const CurvedBody a = hard::ellipsoid_of({1, 2, 5}), b = hard::ellipsoid_of({5, 2, 1});
  const RealBounds found = curved_truth({&a, test::at(0, 0, 0)}, {&b, test::at(4, 4, 4)}, 1e-30);
  const Real known("1.29549481993874080913966969921");
  EXPECT_LE(found.lower, known + Real(1e-29));
  EXPECT_GE(found.upper, known - Real(1e-29));
  EXPECT_LE(found.upper - found.lower, Real(1e-30));
}

TEST(CurvedOracle, AgreesWithRationalsOnHullsOfPoints) {
  for (int seed = 0; seed < 10; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    Body p, q;
    for (int i = 0; i < 6; ++i) {
      p.points.push_back(random.in_box(1.0));
      q.points.push_back(random.in_box(1.0));
    }
    p.radius = 0.25;
    const Pose pose_p = random.pose(1.0), pose_q = compose(test::at(4, 1, 0), random.pose(1.0));
    CurvedBody a, b;
    a.points = p.points;
    a.radius = p.radius;
    b.points = q.points;
    const ExactDistance exact = exact_distance(p, pose_p, q, pose_q);
    const RealBounds found = curved_truth({&a, pose_p}, {&b, pose_q}, 1e-25);
    EXPECT_LE(found.lower, Real(exact.upper)) << seed;
    EXPECT_GE(found.upper, Real(exact.lower)) << seed;
    EXPECT_GT(exact.lower, 0.5) << seed;
  }
}

TEST(CurvedOracle, SaysThatBodiesMeetAndWhatADirectionProvesOfTheirDepth) {
  const CurvedBody a = hard::ellipsoid_of({1, 2, 5}), b = hard::ellipsoid_of({5, 2, 1});
  const PlacedCurvedBody at_a{&a, test::at(0, 0, 0)}, at_b{&b, test::at(1, 1, 1)};
  EXPECT_LT(curved_truth(at_a, at_b, 1e-20).lower, Real(-1e300));
  EXPECT_EQ(apart_along(at_a, at_b, Vec3::UnitY()), Real(-3));
}

}  // namespace
}  // namespace clearance::oracle
