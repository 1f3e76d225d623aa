// One tracking state carried through a million steps. Oracle: the exact distance, at regular
// intervals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;

const int kTrackedSteps = static_cast<int>(repeats(1'000'000));
constexpr int kJudgedEvery = 31'250;

struct PairOfPoses {
  Pose a, b;
};

// B rotates and moves around A in a spiral that closes after several thousand turns. At the closest
// approach `near`, the bodies overlap.
PairOfPoses around(double t, double near, double far) {
  const Vec3 direction(std::cos(t), std::sin(t) * std::cos(0.37 * t),
                       std::sin(t) * std::sin(0.37 * t));
  const double distance = near + (far - near) * (0.5 + 0.5 * std::cos(0.0171 * t));
  const Quat turn(std::cos(0.61 * t), 0.6 * std::sin(0.61 * t), 0.0, 0.8 * std::sin(0.61 * t));
  return {{}, {distance * direction, turn}};
}

// Boxes 0.6 m high, one above the other, as level as quaternions can represent. B slides and
// rotates above A, at 1 mm to 0.8 m, and both tumble together.
PairOfPoses level(double t) {
  const Quat world = test::turned(Vec3(1.0, 2.0, 0.5 * std::sin(0.03 * t)), 0.11 * t);
  const Vec3 over(0.5 * std::sin(0.7 * t), 0.4 * std::sin(1.1 * t),
                  0.601 + 0.4 * (1.0 + std::cos(0.37 * t)));
  return {{Vec3::Zero(), world}, {world * over, world * test::turned(Vec3::UnitZ(), 0.61 * t)}};
}

struct LongRun {
  const char* name;
  hard::Body body;
  PairOfPoses (*at)(double t);
};

void PrintTo(const LongRun& run, std::ostream* out) { *out << run.name; }

const LongRun kRuns[] = {
    {"Boxes", hard::box({0.5, 0.4, 0.3}), [](double t) { return around(t, 0.8, 2.5); }},
    {"Links", hard::link(5, 1.0, 0.2), [](double t) { return around(t, 0.8, 2.5); }},
    {"FacetBalls", hard::facet_ball(10), [](double t) { return around(t, 1.95, 5.0); }},
    {"LevelBoxes", hard::box({0.5, 0.4, 0.3}), level},
};

// A converged answer is within 1e-14 of the scale: both radii and the distance of the origins.
void expect_as_promised(const DistanceResult& r, const oracle::ExactDistance& truth, double scale) {
  if (r.status != DistanceStatus::kConverged) return;
  const double off =
      std::max(std::abs(r.distance - truth.lower), std::abs(r.distance - truth.upper));
  EXPECT_LE(off, 1e-14 * scale);
  EXPECT_LE(r.upper - r.lower, 1e-14 * scale);
}

class LongTracking : public testing::TestWithParam<LongRun> {};

TEST_P(LongTracking, HoldsAfterAMillionSteps) {
  DistanceJudge judge(GetParam().body, GetParam().body);
  TrackingState state;
  int apart = 0;
  for (int k = 1; k <= kTrackedSteps; ++k) {
    const auto [a, b] = GetParam().at(1e-3 * k);
    const DistanceResult result = judge.ask(a, b, state);
    apart += result.status == DistanceStatus::kConverged ? 1 : 0;
    if (k % kJudgedEvery != 0) continue;
    SCOPED_TRACE(k);
    const oracle::ExactDistance truth = judge.truth(a, b);
    for (const std::string& fault : judge.faults(result, truth, a, b)) ADD_FAILURE() << fault;
    const double between = (b.position - a.position).norm();
    expect_as_promised(result, truth,
                       judge.a().bounding_radius + judge.b().bounding_radius + between);
  }
  EXPECT_GT(apart, kTrackedSteps / 2);
}

INSTANTIATE_TEST_SUITE_P(Of, LongTracking, testing::ValuesIn(kRuns),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace clearance
