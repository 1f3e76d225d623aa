// Witness points from tick to tick where whole faces are closest: their motion is compared with the
// motion of the bodies.
//
// If two faces are level as far as doubles can tell, all their points are closest, and a steady
// choice exists. If the tilt is larger, only an edge or a vertex is closest. It changes to the
// opposite one as soon as the tilt changes its sign, so one jump is then correct.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using oracle::Body;
using Quat = Eigen::Quaterniond;
using test::turned;

constexpr int kSteps = 600;
constexpr double kSwings = 40.0;  // frequency of the tilting, in rad per unit of t

struct FacingPair {
  const char* name;
  Body a, b;
  double level;  // distance of the centres at which the faces touch, m
};

Body hexagonal_prism() {
  Body out;
  for (int k = 0; k < 6; ++k) {
    const double azimuth = std::numbers::pi / 3 * k;
    out.rows.push_back({Vec3(std::cos(azimuth), std::sin(azimuth), 0), 0.5});
  }
  out.rows.push_back({Vec3(0, 0, 1), 0.3});
  out.rows.push_back({Vec3(0, 0, -1), 0.3});
  return out;
}

std::vector<FacingPair> facing_pairs() {
  return {{"boxes", hard::box({0.5, 0.4, 0.3}), hard::box({0.25, 0.2, 0.15}), 0.45},
          {"equal cubes", hard::box({0.3, 0.3, 0.3}), hard::box({0.3, 0.3, 0.3}), 0.6},
          {"a box over a plate", hard::box({1, 1, 0.005}), hard::box({0.25, 0.2, 0.15}), 0.155},
          {"plates", hard::box({1, 1, 0.005}), hard::box({0.8, 0.9, 0.005}), 0.01},
          {"prisms", hexagonal_prism(), hexagonal_prism(), 0.6},
          {"links", hard::link(6, 1.0, 0.1), hard::link(6, 0.7, 0.1), 0.1}};
}

// The pose of the upper body at t in [-1, 1], tilted by at most `tilt`. The lower body lies at the
// origin.
struct Swing {
  const char* name;
  std::function<Pose(double t, double height, double tilt)> pose;
};

const Vec3 kAslant(0.6, 0.8, 0.0);

std::vector<Swing> motions() {
  return {{"slides, tilted",
           [](double t, double height, double tilt) {
             return Pose{{0.2 * t, 0.1 * t, height}, turned(Vec3::UnitY(), tilt)};
           }},
          {"slides and swings",
           [](double t, double height, double tilt) {
             return Pose{{0.2 * t, 0.1 * t, height},
                         turned(Vec3::UnitY(), tilt * std::sin(kSwings * t))};
           }},
          {"sinks and swings",
           [](double t, double height, double tilt) {
             return Pose{
                 {0.3, 0.1, height + 0.05 * t},
                 turned(Vec3::UnitZ(), 0.3) * turned(kAslant, tilt * std::sin(kSwings * t))};
           }},
          {"spins and swings", [](double t, double height, double tilt) {
             return Pose{
                 {0.2 * t, 0.1 * t, height},
                 turned(Vec3::UnitZ(), 0.5 * t) * turned(kAslant, tilt * std::sin(kSwings * t))};
           }}};
}

struct Moved {
  double witness = 0.0, bodies = 0.0;  // movement in one step, m, in the world
};

std::vector<Moved> run(const FacingPair& pair, const Swing& motion, double tilt,
                       const Quat& world) {
  const DistanceJudge judge(pair.a, pair.b);
  const double reach = judge.b().bounding_radius;
  const Pose below{Vec3::Zero(), world};
  TrackingState state;
  std::vector<Moved> out;
  Pose last;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
  for (int k = 0; k < kSteps; ++k) {
    const Pose up = motion.pose(2.0 * k / kSteps - 1.0, pair.level + 0.1, tilt);
    const Pose above{world * up.position, world * up.orientation};
    const DistanceResult r = judge.ask(below, above, state);
    if (k > 0) {
      out.push_back({std::max((r.point_on_a - on_a).norm(), (r.point_on_b - on_b).norm()),
                     (above.position - last.position).norm() +
                         reach * above.orientation.angularDistance(last.orientation)});
    }
    last = above;
    on_a = r.point_on_a;
    on_b = r.point_on_b;
  }
  return out;
}

void for_each_run(
    const std::vector<double>& tilts,
    const std::function<void(const FacingPair&, const Swing&, double, const Quat&)>& visit) {
  const Quat worlds[] = {{1, 0, 0, 0}, Quat(0.5, 0.5, 0.5, 0.5) * turned(kAslant, 0.7)};
  for (const FacingPair& pair : facing_pairs()) {
    for (const Swing& motion : motions()) {
      for (const double tilt : tilts) {
        for (const Quat& world : worlds) {
          SCOPED_TRACE(std::string(pair.name) + ", " + motion.name + ", tilt " +
                       std::to_string(std::log10(tilt)));
          visit(pair, motion, tilt, world);
        }
      }
    }
  }
}

TEST(Witnesses, OfParallelFacesMoveNoFasterThanTheBodies) {
  for_each_run({0.0, 1e-16, 2e-16},
               [](const FacingPair& pair, const Swing& motion, double tilt, const Quat& world) {
                 double fastest = 0.0;
                 for (const Moved& moved : run(pair, motion, tilt, world)) {
                   fastest = std::max(fastest, moved.witness / (moved.bodies + 1e-15));
                 }
                 EXPECT_LE(fastest, 1.0 + 1e-9);
               });
}

// sin(40 t) has 25 zeros. While a body spins, another vertex may become the lowest one.
void expect_jumps(const std::vector<double>& tilts, int most_a_turn) {
  constexpr int kTurns = 25, kOfSpinning = 2;
  for_each_run(tilts,
               [=](const FacingPair& pair, const Swing& motion, double tilt, const Quat& world) {
                 int jumps = 0;
                 for (const Moved& moved : run(pair, motion, tilt, world)) {
                   jumps += moved.witness > 10.0 * moved.bodies + 1e-9;
                 }
                 EXPECT_LE(jumps, most_a_turn * kTurns + kOfSpinning);
               });
}

TEST(Witnesses, OfTiltedFacesJumpOnceWhenTheTiltTurnsOver) { expect_jumps({1e-11, 1e-9, 1e-7}, 1); }

// At these tilts, rounding decides which steps of a turn are level.
TEST(Witnesses, OfFacesAtTheBrinkOfParallelJumpAtMostThriceATurnOnAverage) {
  expect_jumps({7e-16, 1e-15, 2e-15, 5e-15, 1e-14, 1e-13, 1e-12}, 3);
}

// Bars that lie on an edge and cross in the middle. The depth is the same upwards and downwards,
// across two pairs of edges each, and rounding decides which is smaller.
TEST(Witnesses, OfBarsThatCrossInTheMiddleMoveNoFasterThanTheBars) {
  const Body bar =
      hard::rotated(hard::box({1.0, 0.1, 0.1}), turned(Vec3::UnitX(), std::numbers::pi / 4));
  const DistanceJudge judge(bar, bar);
  const double reach = judge.b().bounding_radius;
  const std::function<Pose(double)> crossings[] = {
      [](double t) {
        return Pose{Vec3::Zero(), turned(Vec3::UnitZ(), 1.5 + 0.5 * t)};
      },
      [](double t) {
        return Pose{{0.3 * t, 0.2 * t, 0.0}, turned(Vec3::UnitZ(), 1.2)};
      },
      [](double t) {
        return Pose{{0.2 * t, 0.1, 1e-16 * std::sin(kSwings * t)}, turned(Vec3::UnitZ(), 2.0)};
      }};
  for (const Quat& world : {Quat(1, 0, 0, 0), Quat(0.5, 0.5, 0.5, 0.5) * turned(kAslant, 0.7)}) {
    for (const auto& crossing : crossings) {
      TrackingState state;
      DistanceResult last;
      Pose before;
      for (int k = 0; k < kSteps; ++k) {
        const Pose at = crossing(2.0 * k / kSteps - 1.0);
        const Pose now{world * at.position, world * at.orientation};
        const DistanceResult r = judge.ask({Vec3::Zero(), world}, now, state);
        EXPECT_EQ(r.status, DistanceStatus::kOverlapping);
        if (k > 0) {
          // The witness points of crossing edges move along both edges, by the movement divided by
          // the sine of their angle.
          const double moved = (now.position - before.position).norm() +
                               reach * now.orientation.angularDistance(before.orientation);
          EXPECT_LE((r.point_on_a - last.point_on_a).norm(), 3.0 * moved + 1e-12) << "step " << k;
          EXPECT_LE((r.normal - last.normal).norm(), 3.0 * moved + 1e-12) << "step " << k;
        }
        before = now;
        last = r;
      }
    }
  }
}

}  // namespace
}  // namespace clearance
