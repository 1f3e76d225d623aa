// Bodies without end whose rays, facets or edges are level against the other body, or all but level
// to each other: what rounding leaves open there must not cost more than rounding.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "core/gjk/closest_on_simplex.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/every_start.hpp"
#include "tests/shared/hard_bodies.hpp"

namespace clearance {
namespace {

using oracle::Body;

Pose at(const Vec3& position) { return {position, Eigen::Quaterniond::Identity()}; }

// From whatever features a query begins at.
void expect_right(const Body& a, const Body& b, const Pose& a_at, const Pose& b_at,
                  const std::string& what) {
  DistanceJudge judge(a, b);
  ASSERT_EQ(judge.refusal(), "") << what;
  EXPECT_EQ(test::fault_from_any_start(judge, a_at, b_at), "") << what;
}
void expect_right(const Body& a, const Body& b, const Vec3& a_at, const Vec3& b_at,
                  const std::string& what) {
  expect_right(a, b, at(a_at), at(b_at), what);
}

// The rays to both sides of its ridge all but cancel; along its ridge it is level.
TEST(NearlyLevel, GablesOfAnySlopeAreAsFarFromACubeAboveThem) {
  const Body cube = hard::box(Vec3(1.0, 1.0, 1.0));
  for (const double slope : {0.1, 0.03, 0.01, 1e-3, 1e-6, 1e-9, 1e-12}) {
    const Body gable{{{{0.0, slope, 1.0}, 1.0}, {{0.0, -slope, 1.0}, 1.0}, {{1.0, 0.0, 0.0}, 1.0}},
                     {}};
    const std::string what = "slope " + std::to_string(slope);
    expect_right(gable, cube, Vec3::Zero(), {-3.0, 0.5, 4.0}, what);
    expect_right(gable, cube, Vec3::Zero(), {-3.0, 1.0, 4.0}, what);
    const Body whole{{gable.rows[0], gable.rows[1]}, {}};  // its ridge a line
    expect_right(whole, cube, Vec3::Zero(), {-3.0, 0.5, 4.0}, what + ", a line");
    expect_right(cube, whole, {-3.0, 1.0, 4.0}, Vec3::Zero(), what + ", a line, as B");
  }
}

// No edge of theirs leads closer where facets are level to rounding, but their inside does.
TEST(NearlyLevel, BodiesWithoutEndAreLeftThroughTheirInside) {
  const Body channel{{{{0.0, 1.0, 0.0}, 0.001},
                      {{0.0, -1.0, 0.0}, 0.0},
                      {{1.0, 0.0, 0.0}, 0.0},
                      {{1.0, 0.0, 1e-17}, 0.0}},
                     {}};
  const Body plate{{{{0.0, 1.0, 0.0}, 1e-11}, {{0.0, -1.0, 0.0}, 0.0}, {{1.0, 1.0, 0.0}, 0.0}}, {}};
  expect_right(channel, plate, {0.9, -0.5, -2.0}, Vec3::Zero(), "channel and plate");
  const Body ground{{{{0.0, 0.0, 1.0}, 1.0}, {{0.0, 1e-17, 1.0}, 1.0}}, {}};
  const Body floor{{{{0.0, 0.0, 1.0}, 1.0}}, {}};
  expect_right(ground, floor, {-1.0, 0.0, 0.5}, Vec3::Zero(), "ground and floor");
  // Their vertices' middle lies on the level side, too.
  const Body ledge{
      {{{0.0, -1.5e-16, 1.0}, 0.5}, {{-1.0, 0.0, -3e-16}, 0.0}, {{3e-16, 0.0, 1.0}, 0.5}}, {}};
  const Body roof{{{{3e-16, 1.0, -6e-16}, 1.0}, {{0.0, 1.0, 0.0}, 1.0}, {{0.0, 3e-16, -1.0}, 1.0}},
                  {}};
  const Pose over{{0.0, 0.0, -1.0}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)};
  expect_right(ledge, roof, at(Vec3::Zero()), over, "ledge and roof");
}

// A quarter of space whose one side is two facets that lean by next to nothing: the edges between
// them and the other side point away from each other but for that, and the doubles of their sum say
// nothing of the facet between them.
Body leaning_quarter(double lean) {
  return {{{{1.0, lean, -0.5 * lean}, 1.0}, {{1.0, 0.0, -lean}, 1.0}, {{0.0, 1.0, 0.0}, 0.0}}, {}};
}

TEST(NearlyLevel, AFacetBetweenEdgesThatPointAwayFromEachOtherLeadsCloser) {
  const Body cube = hard::box(Vec3(1.0, 1.0, 1.0));
  for (const double lean : {1e-18, 1e-17, 1e-16}) {
    const std::string what = "leaning by " + std::to_string(lean * 1e18) + "e-18";
    expect_right(leaning_quarter(lean), cube, Vec3::Zero(), {-0.5, 0.0, 1.0}, what);
    expect_right(cube, leaning_quarter(lean), {-0.5, 0.5, 0.5}, Vec3::Zero(), what);
  }
}

TEST(NearlyLevel, RaysThatPointAwayFromEachOtherAddUpToOneThatNoTranslationPasses) {
  const Body cube = hard::box(Vec3(1.0, 1.0, 1.0));
  for (const double lean : {1e-18, 1e-17, 1e-16}) {
    for (const double half : {0.1, 0.2, 0.4, 0.6}) {
      const Pose deep{{-2.0, -1.5, 0.25}, Eigen::Quaterniond(std::cos(half), 0, 0, std::sin(half))};
      const std::string what = "turned by half of " + std::to_string(half);
      expect_right(leaning_quarter(lean), cube, at(Vec3::Zero()), deep, what);
    }
  }
}

// Its edges all but go on as one line; how fast it rises along what is level along that one only
// to rounding must not count over the little that they lean.
TEST(NearlyLevel, EdgesThatAllButGoOnAsOneLineCostNoMoreThanRounding) {
  const Body cube = hard::box(Vec3(1.0, 1.0, 1.0));
  for (const double lean : {1e-15, 1e-14, 1e-12, 1e-9}) {
    const Body corner{{{{0.0, lean, 1.0}, 1.0}, {{0.0, 0.0, 1.0}, 1.0}, {{1.0, 0.0, lean}, 0.5}},
                      {}};
    for (const double half : {0.3, 0.7, 1.1}) {
      for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
        const Pose turned{{3.0, 2.5, 0.5}, Eigen::Quaterniond(Eigen::AngleAxisd(2.0 * half, axis))};
        expect_right(corner, cube, at(Vec3::Zero()), turned,
                     "lean " + std::to_string(-std::log10(lean)) + ", " + std::to_string(half));
      }
    }
  }
}

// Of points and directions that are as good to rounding, those that belong together are taken.
TEST(NearlyLevel, WitnessPointsOfTheRobustPathLieAlongItsNormal) {
  const Body channel{{{{0.0, 1.0, 0.0}, 2.7413532579094894e-12},
                      {{0.0, -1.0, 0.0}, 0.0},
                      {{1.0, 0.0, 4.0389011919380624e-14}, 0.0}},
                     {}};
  const Body bar{{{{1.0, 0.0, 0.0}, 6.2317549829373216e-09},
                  {{-1.0, 0.0, 0.0}, 6.2317549829373216e-09},
                  {{0.0, 1.0, 0.0}, 0.0066918567067290871},
                  {{0.0, -1.0, 0.0}, 0.0066918567067290871},
                  {{0.0, 0.0, -1.0}, 0.0}},
                 {}};
  expect_right(channel, bar, {-2.750262729431562e-12, 0.0, 0.0}, {0.0, -2.0, 1.0}, "bar");
}

// A wedge whose edge is 3e14 m away, and a channel with one ray that leans towards it by 1e-323.
TEST(NearlyLevel, WhereOnlyWideBoundsAreKnownTheNormalLeadsFromPointToPoint) {
  const Body wedge{{{{0.0, 1.0, 0.0}, 0.5}, {{-0x1.8p-49, -1.0, 0.0}, 0.25}}, {}};
  const Body channel{{{{-0.75, 0.625, 0.5}, 0.5},
                      {{0.125, 1.0, 0.0}, -0.5},
                      {{-1.0, -0.375, 0.0}, 0.5},
                      {{0.125, -1.0, 0.0}, 0.5}},
                     {}};
  const Pose under{Vec3::Zero(), Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0)};
  const Pose above{{556.0, 372.0, 132.0}, Eigen::Quaterniond(0.0, 1.0, 0.0, -0x1p-1074)};
  const DistanceJudge judge(wedge, channel);
  ASSERT_EQ(judge.refusal(), "");
  TrackingState state;
  const DistanceResult r = judge.ask(under, above, state);
  ASSERT_EQ(r.status, DistanceStatus::kIterationLimit);
  ASSERT_GT(r.distance, 300.0);
  EXPECT_LT((r.point_on_b - r.point_on_a - r.distance * r.normal).norm(), 1e-9);
}

// However thin: the point that they make is no more than rounding from their hull.
TEST(NearlyLevel, WeightsOfASimplexAddUpToOne) {
  Random random(7);
  int inside = 0;
  for (int k = 0; k < 100000; ++k) {
    const double thick = random.log_uniform(1e-26, 1.0), wide_by = random.log_uniform(1e-26, 1.0);
    const Mat3 turn = random.rotation().toRotationMatrix();
    std::array<WideVec, 4> corners;
    for (WideVec& corner : corners) {
      const WideVec own = wide(Vec3(random.uniform(-1.0, 1.0), wide_by * random.uniform(-1.0, 1.0),
                                    thick * random.uniform(-1.0, 1.0)));
      corner = {dot(wide(turn.row(0)), own), dot(wide(turn.row(1)), own),
                dot(wide(turn.row(2)), own)};
    }
    const ClosestPoint closest = closest_to_origin(corners, 4);
    double sum = -1.0;
    for (const DoubleDouble& weight : closest.weights) sum += static_cast<double>(weight);
    ASSERT_NEAR(sum, 0.0, 1e-14) << k;
    inside += closest.weights[3].high > 0.0 && closest.weights[0].high > 0.0;
  }
  EXPECT_GT(inside, 1000);
}

}  // namespace
}  // namespace clearance
