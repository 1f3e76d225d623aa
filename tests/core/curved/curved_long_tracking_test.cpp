// One tracking state of curved bodies, carried through a million steps. Oracle: 50 digits, at
// regular intervals.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "core/distance.hpp"
#include "tests/shared/curved_judge.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

constexpr int kLongSteps = 1'000'000, kLongJudged = 16;

oracle::CurvedBody long_ellipsoid() {
  oracle::CurvedBody body;
  body.shape.kind = CurvedShape::Kind::kEllipsoid;
  body.shape.semi_axes = Vec3(0.2, 0.3, 0.5);
  return body;
}

oracle::CurvedBody long_cone(double low, double high) {
  oracle::CurvedBody body;
  body.shape.kind = CurvedShape::Kind::kTruncatedCone;
  body.shape.discs = {Disc{-0.3, low}, Disc{0.3, high}};
  return body;
}

// B moves around A in a spiral and rotates. The distance between the centres is 0.7 m to 2 m.
std::pair<Pose, Pose> spiral(double t) {
  const double far = 1.35 + 0.65 * std::cos(0.0171 * t);
  const Vec3 direction(std::cos(t), std::sin(t) * std::cos(0.37 * t),
                       std::sin(t) * std::sin(0.37 * t));
  return {Pose{}, {far * direction, test::turned({0.6, 0.0, 0.8}, 1.22 * t)}};
}

// Two caps at a distance of 1 mm to 0.4 m, as parallel as quaternions can represent. Both bodies
// tumble together.
std::pair<Pose, Pose> sliding_caps(double t) {
  const Eigen::Quaterniond world = test::turned({1.0, 2.0, 0.5}, 0.11 * t);
  const Vec3 over(0.3 * std::sin(0.7 * t), 0.2 * std::sin(1.1 * t),
                  0.601 + 0.2 * (1.0 + std::cos(0.37 * t)));
  return {{Vec3::Zero(), world}, {world * over, world * test::turned(Vec3::UnitZ(), 0.61 * t)}};
}

struct CurvedRun {
  const char* name;
  oracle::CurvedBody a, b;
  std::pair<Pose, Pose> (*at)(double t);
};

void PrintTo(const CurvedRun& run, std::ostream* out) { *out << run.name; }

class CurvedLongTracking : public testing::TestWithParam<CurvedRun> {};

TEST_P(CurvedLongTracking, HoldsAfterAMillionSteps) {
  const CurvedRun& run = GetParam();
  const ConvexBody a = test::made(hard::curved_model(run.a));
  const ConvexBody b = test::made(hard::curved_model(run.b));
  TrackingState state;
  int converged = 0;
  for (int k = 1; k <= kLongSteps; ++k) {
    const auto [pose_a, pose_b] = run.at(1e-3 * k);
    const DistanceResult r = distance(a, b, pose_a, pose_b, state);
    converged += r.status == DistanceStatus::kConverged ? 1 : 0;
    if (k % (kLongSteps / kLongJudged) != 0) continue;
    SCOPED_TRACE(k);
    const CurvedJudge judge({run.a, run.b, pose_a, pose_b});
    for (const std::string& fault : judge.faults(r)) ADD_FAILURE() << fault;
  }
  EXPECT_GT(converged, kLongSteps * 9 / 10);
}

INSTANTIATE_TEST_SUITE_P(
    Of, CurvedLongTracking,
    testing::Values(CurvedRun{"Ellipsoids", long_ellipsoid(), long_ellipsoid(), spiral},
                    CurvedRun{"ConeAndEllipsoid", long_cone(0.3, 0.1), long_ellipsoid(), spiral},
                    CurvedRun{"Caps", long_cone(0.3, 0.3), long_cone(0.2, 0.2), sliding_caps}),
    [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace clearance
