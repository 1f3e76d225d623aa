// Unbounded bodies with rays, facets or edges level with the other body. Rounding that remains
// undecided there must change the answer by no more than rounding.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "core/gjk/simplex.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/every_start.hpp"
#include "tests/shared/hard_bodies.hpp"

namespace clearance {
namespace {

using oracle::Body;

Pose at(const Vec3& position) { return {position, Eigen::Quaterniond::Identity()}; }

// The answers are right for all initial features.
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

// The rays on both sides of the ridge almost cancel. The ridge itself is level.
TEST(NearlyParallel, GablesOfAnySlopeAreAsFarFromACubeAboveThem) {
  const Body cube = hard::box(Vec3(1.0, 1.0, 1.0));
  for (const double slope : {0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-5}) {
    const Body gable{{{{0.0, slope, 1.0}, 1.0}, {{0.0, -slope, 1.0}, 1.0}, {{1.0, 0.0, 0.0}, 1.0}},
                     {}};
    const std::string what = "slope " + std::to_string(slope);
    expect_right(gable, cube, Vec3::Zero(), {-3.0, 0.5, 4.0}, what);
    expect_right(gable, cube, Vec3::Zero(), {-3.0, 1.0, 4.0}, what);
    const Body whole{{gable.rows[0], gable.rows[1]}, {}};  // its ridge is a line
    expect_right(whole, cube, Vec3::Zero(), {-3.0, 0.5, 4.0}, what + ", a line");
    expect_right(cube, whole, {-3.0, 1.0, 4.0}, Vec3::Zero(), what + ", a line, as B");
  }
}

// However thin the simplex is, its weighted point lies within rounding of the hull.
TEST(NearlyParallel, WeightsOfASimplexAddUpToOne) {
  Random random(7);
  int inside = 0;
  for (int k = 0; k < 100000; ++k) {
    const double thick = random.log_uniform(1e-26, 1.0), wide_by = random.log_uniform(1e-26, 1.0);
    const Mat3 turn = random.rotation().toRotationMatrix();
    std::array<Vector<DoubleDouble>, 4> corners;
    for (Vector<DoubleDouble>& corner : corners) {
      const Vector<DoubleDouble> own = vector_of<DoubleDouble>(
          Vec3(random.uniform(-1.0, 1.0), wide_by * random.uniform(-1.0, 1.0),
               thick * random.uniform(-1.0, 1.0)));
      corner = {dot(vector_of<DoubleDouble>(turn.row(0)), own),
                dot(vector_of<DoubleDouble>(turn.row(1)), own),
                dot(vector_of<DoubleDouble>(turn.row(2)), own)};
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
