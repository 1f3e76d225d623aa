// The methods of the thesis's chapter 5 that clearance-bench compares. They are compared with its
// golden values and with 50 digits, so that no competing method is implemented worse than it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <variant>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tools/bench/random.hpp"
#include "tools/bench/thesis/chapter5/alternating.hpp"
#include "tools/bench/thesis/chapter5/digits50.hpp"
#include "tools/bench/thesis/chapter5/facet_ball.hpp"
#include "tools/bench/thesis/chapter5/free_margin.hpp"
#include "tools/bench/thesis/chapter5/methods.hpp"
#include "tools/bench/thesis/chapter5/point_families.hpp"
#include "tools/bench/thesis/chapter5/polyhedron_to_ellipsoid.hpp"
#include "tools/bench/thesis/chapter5/support_gjk.hpp"
#include "tools/bench/workload.hpp"

namespace clearance::bench {
namespace {

double d_error(const ClosestPoints& found, const TruePoints& truth) {
  return std::abs(found.distance() - truth.distance);
}

const Method& method(const std::string& name) {
  const auto found = std::find_if(methods().begin(), methods().end(),
                                  [&](const Method& m) { return m.name == name; });
  EXPECT_NE(found, methods().end()) << name;
  return *found;
}

TEST(Chapter5Truth, HasTheDigitsOfTheStandardTest) {
  EXPECT_EQ(distance_digits(crossed_pair(kStandard), 30), "1.29549481993874080913966969921");
  const ClosestPoints printed{{0.13705777781256, 1.43051641611194, 3.42644444486425},
                              {0.57355555513575, 2.56948358388806, 3.86294222218744}};
  EXPECT_LT(x_error(printed, crossed_test(kStandard).truth.points), 1e-10);
}

TEST(Chapter5Truth, MovesTheCrossedEllipsoidsToTheSeparationAskedFor) {
  for (const double separation : kSeparations) {
    const CrossedTest test = crossed_test(separation);
    if (separation != kStandard) {
      EXPECT_NEAR(test.truth.distance, separation, 1e-13);
    }
    EXPECT_LT((test.truth.points.on_a - crossed_test(kStandard).truth.points.on_a).norm(), 1e-10);
  }
}

TEST(Chapter5Truth, AgreesWithTheReferenceOfTurnedEllipsoids) {
  const Workload& load = workload("ellipsoid-ellipsoid");
  for (std::size_t i = 0; i < load.trajectories.size(); ++i) {
    const Trajectory& t = load.trajectories[i];
    const auto& [a, b] = t.poses[i];
    EXPECT_NEAR(true_distance(t.a->curved.semi_axes, a, t.b->curved.semi_axes, b),
                load.truth[i][i].distance, 3e-16);
  }
}

TEST(Chapter5Points, NewtonIsRightToRoundingEverywhere) {
  for (const PointFamily& family : kPointFamilies) {
    for (const PointCase& c : point_cases(family.name)) {
      const NearestPoint<3> found = by_newton(c.axes, c.p);
      ASSERT_TRUE(found.converged);
      ASSERT_NEAR((found.point - c.p).norm(), c.distance, 1e-15 * c.size()) << family.name;
      ASSERT_NEAR(found.point.cwiseQuotient(c.axes).norm(), 1.0, 1e-15) << family.name;
    }
  }
}

TEST(Chapter5Points, DominantTermIsRightToRoundingWhereTheThesisTriedIt) {
  for (const char* family : {"thesis", "ratios", "surface"}) {
    for (const PointCase& c : point_cases(family)) {
      ASSERT_NEAR((by_dominant_term(c.axes, c.p).point - c.p).norm(), c.distance, 1e-14 * c.size())
          << family;
    }
  }
}

TEST(Chapter5Alternating, TakesTheRoundsThatTheThesisCounts) {
  struct Counted {
    double separation, tolerance;
    int rounds;
  };
  // §5.2. The thesis's 21 rounds to 1e-8 at the standard test are left out. This implementation
  // needs 25, with a ratio of 0.49 per round, which agrees with the thesis's 14 rounds to 1e-4.
  for (const Counted& c : {Counted{kStandard, 1e-4, 14}, {0.1, 1e-4, 78}, {0.1, 1e-8, 163}}) {
    const CrossedTest test = crossed_test(c.separation);
    const bench::Run run = [&](int rounds) {
      return alternate(test.pair, by_dominant_term, rounds, Turns::kTogether);
    };
    EXPECT_NEAR(rounds_to(c.tolerance, run, 1000, test.truth.points), c.rounds, 1.0);
  }
}

TEST(Chapter5Alternating, EndsAtTheTruth) {
  for (const char* name : {"alternating", "alternating-dominant", "hybrid"}) {
    for (const double separation : kSeparations) {
      const CrossedTest test = crossed_test(separation);
      const ClosestPoints found = method(name).prepared(test.pair)(100'000);
      EXPECT_TRUE(found.converged) << name << ' ' << separation;
      EXPECT_LT(d_error(found, test.truth), 1e-14) << name << ' ' << separation;
      EXPECT_LT(x_error(found, test.truth.points), 1e-9) << name << ' ' << separation;
    }
  }
}

TEST(Chapter5FacetBalls, HaveTheFacetsAndErrorsOfTable51) {
  struct Row {
    int order, facets;
    double x_error, d_error;
  };
  const CrossedTest test = crossed_test(kStandard);
  for (const Row& row : {Row{4, 44, 0.651, 0.564},
                         {6, 92, 0.417, 0.301},
                         {8, 164, 0.242, 0.0961},
                         {10, 256, 0.123, 0.0338},
                         {15, 576, 0.148, 0.00395}}) {
    FacetBallPair models(test.pair, row.order);
    EXPECT_EQ(models.facets(), static_cast<std::size_t>(row.facets));
    const ClosestPoints found = models.closest<Scan::kAllFacets>(test.pair.apart);
    EXPECT_TRUE(found.converged);
    EXPECT_NEAR(x_error(found, test.truth.points), row.x_error, 0.006 * row.x_error) << row.order;
    EXPECT_NEAR(d_error(found, test.truth), row.d_error, 0.006 * row.d_error) << row.order;
  }
}

TEST(Chapter5Refinement, ComesWithin1em4OfThePointsAtEverySeparation) {
  for (const char* name : {"refinement-4", "refinement-7"}) {
    for (const double separation : kSeparations) {
      const CrossedTest test = crossed_test(separation);
      const bench::Run run = method(name).prepared(test.pair);
      const int cycles = rounds_to(1e-4, run, 200, test.truth.points);
      EXPECT_GT(cycles, 0) << name << ' ' << separation;
      EXPECT_LT(cycles, 25) << name << ' ' << separation;
      EXPECT_LT(d_error(run(200), test.truth), 1e-11) << name << ' ' << separation;
    }
  }
}

TEST(Chapter5Line, ItsClosestPointsHaveOneNormalAcrossTheLine) {
  Random random(7);
  for (int k = 0; k < 1000; ++k) {
    const Vec3 axes(random.uniform(0.1, 5.0), random.uniform(0.1, 5.0), random.uniform(0.1, 5.0));
    const Line line{random.uniform(6.0, 20.0) * random.direction(), random.direction()};
    const ClosestPoints found = line_to_ellipsoid(line, axes);
    const Vec3 between = found.on_a - found.on_b;
    if (between.norm() < 1e-9) {  // the line passes through the ellipsoid
      EXPECT_LE(found.on_b.cwiseQuotient(axes).norm(), 1.0 + 1e-12);
      continue;
    }
    EXPECT_NEAR(found.on_b.cwiseQuotient(axes).norm(), 1.0, 1e-13);
    EXPECT_NEAR(between.dot(line.direction), 0.0, 1e-12);
    EXPECT_LT((found.on_a - line.point).cross(line.direction).norm(), 1e-12);
    const Vec3 normal = found.on_b.cwiseQuotient(axes.cwiseAbs2()).normalized();
    EXPECT_NEAR(normal.dot(between), between.norm(), 1e-12);
  }
}

TEST(Chapter5PolyhedronToEllipsoid, FindsTheDistanceOfAFacetBallAndAnEllipsoid) {
  Random random(8);
  const Vec3 axes(5.0, 2.0, 1.0);
  const auto b = std::get<ConvexBody>(ellipsoid(axes));
  for (const int order : {2, 4, 10}) {
    const ConvexBody a = ellipsoid_model({1.0, 2.0, 5.0}, order);
    for (int k = 0; k < 100; ++k) {
      const Vec3 apart = random.uniform(10.5, 14.0) * random.direction();
      TrackingState cold;
      const DistanceResult truth = distance(a, b, Pose{}, Pose{apart}, cold);
      const ClosestPoints found = polyhedron_to_ellipsoid(a, axes, apart);
      EXPECT_TRUE(found.converged);
      EXPECT_NEAR(found.distance(), truth.distance, 1e-13) << order << ' ' << k;
    }
  }
}

TEST(Chapter5FreeMargin, ScalesAUntilItTouchesB) {
  for (const double separation : kSeparations) {
    const EllipsoidPair pair = crossed_pair(separation);
    const FreeMargin found = free_margin(pair);
    const Vec3 grown = (1.0 + found.margin) * pair.axes_a;
    const Vec3 in_a = found.touched.cwiseQuotient(grown);
    const Vec3 in_b = (found.touched - pair.apart).cwiseQuotient(pair.axes_b);
    EXPECT_NEAR(in_a.norm(), 1.0, 1e-10);
    EXPECT_NEAR(in_b.norm(), 1.0, 1e-10);
    const Vec3 normal_a = in_a.cwiseQuotient(grown).normalized();
    const Vec3 normal_b = in_b.cwiseQuotient(pair.axes_b).normalized();
    EXPECT_NEAR(normal_a.dot(normal_b), -1.0, 1e-10);
    EXPECT_GE((found.touched - found.nearest).norm(), separation - 1e-4);
  }
  EXPECT_LT(free_margin({{1.0, 2.0, 5.0}, {5.0, 2.0, 1.0}, Vec3::Constant(1.0)}).margin, 0.0);
}

TEST(Chapter5Gjk, IsAsExactAsItsToleranceAsks) {
  for (const double separation : kSeparations) {
    const CrossedTest test = crossed_test(separation);
    const ClosestPoints found = support_gjk(test.pair, 1e-12, 10'000);
    EXPECT_TRUE(found.converged) << separation;
    EXPECT_LT(d_error(found, test.truth), 1e-11) << separation;
  }
}

TEST(Chapter5Ours, IsRightToRoundingAtEverySeparationTrackedAndCold) {
  for (const char* name : {"ours", "ours-tracked"}) {
    for (const double separation : kSeparations) {
      const CrossedTest test = crossed_test(separation);
      EXPECT_LT(d_error(method(name).prepared(test.pair)(0), test.truth), 1e-14) << name;
    }
  }
}

}  // namespace
}  // namespace clearance::bench
