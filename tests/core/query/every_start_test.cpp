// Pairs of few features, asked from every pair of features, and from the state of bodies that
// touched. Oracle: the exact distance.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/shared/distance_judge.hpp"
#include "tests/shared/every_start.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/poses.hpp"

namespace clearance {
namespace {

using oracle::Body;
using test::at;
using test::turned;

constexpr double kEighthTurn = 0.25 * std::numbers::pi;

Body capsule_to(const Vec3& to, double radius = 0.0) {
  return {.rows = {}, .points = {-to, to}, .radius = radius};
}
Body ball_of(double radius) { return {.rows = {}, .points = {Vec3::Zero()}, .radius = radius}; }
Body with_radius(Body body, double radius) {
  body.radius = radius;
  return body;
}
Body ground() { return {.rows = {{Vec3::UnitZ(), 0.0}}, .points = {}}; }
// All x, y, z of 0 or less.
Body corner_of_space() {
  return {.rows = {{Vec3::UnitX(), 0.0}, {Vec3::UnitY(), 0.0}, {Vec3::UnitZ(), 0.0}}, .points = {}};
}
// All x and y of 0 or less, and all z.
Body quarter_space() {
  return {.rows = {{Vec3::UnitX(), 0.0}, {Vec3::UnitY(), 0.0}}, .points = {}};
}
// Opens downwards from its tip at the origin.
Body pyramid_of(double half_width) {
  const double w = half_width;
  return {.rows = {}, .points = {Vec3::Zero(), {w, w, -1}, {-w, w, -1}, {-w, -w, -1}, {w, -w, -1}}};
}

struct TouchingPair {
  const char* name;
  Body a, b;
  Pose pose_b;
};

std::vector<TouchingPair> touching_pairs() {
  const Body cube = hard::box({0.5, 0.5, 0.5}), blade = hard::box({0.2, 2.0, 1.0});
  const Eigen::Quaterniond eighth = turned(Vec3::UnitZ(), kEighthTurn);
  return {
      {"cubes corner to corner", cube, cube, at(1, 1, 1)},
      {"cubes edge to edge", cube, cube, at(1, 0, 1)},
      {"cubes that overlap deeply", cube, cube, at(0.1, 0.2, 0.3)},
      {"a blade within the corner of a plate",
       hard::box({1, 1, 1}),
       blade,
       {{1.1, 1.1, 1.9}, eighth}},
      {"the same, the other way round", blade, hard::box({1, 1, 1}), {{-1.5, 0.05, 1.9}, eighth}},
      {"a blade deep in a plate", hard::box({1, 1, 1}), blade, {{0.1, 0.2, 0.3}, eighth}},
      {"a corner without end and a cube's corner", corner_of_space(), cube, at(0.5, 0.5, 0.5)},
      {"an edge without end and a cube's corner", quarter_space(),
       hard::rotated(cube, turned({1, -1, 0}, std::atan(std::sqrt(2.0)))), at(0.5, 0.5, 0.0)},
      {"an edge without end and a pyramid's tip",
       quarter_space(),
       pyramid_of(0.5),
       {{0, 0, 0.25}, turned({1, -1, 0}, 0.5 * std::numbers::pi)}},
      {"a floor and a pyramid's tip",
       ground(),
       pyramid_of(0.5),
       {{0.1, 0.2, 0.0}, turned(Vec3::UnitX(), std::numbers::pi)}},
      {"tips that meet",
       pyramid_of(1e-3),
       pyramid_of(0.5),
       {{0, 0, 0}, turned(Vec3::UnitX(), 3.0)}},
      {"a tip on an edge",
       pyramid_of(1e-3),
       cube,
       {{0.5, 0.1, 0.5}, turned(Vec3::UnitY(), std::numbers::pi)}},
      {"a segment on a cube's face", cube, capsule_to({0.25, 0.25, 0}), at(0.1, 0.1, 0.5)},
      {"a segment on a cube's edge", cube, capsule_to({0.25, 0, 0}), at(0.1, 0.5, 0.5)},
      {"a segment across a cube's edge", cube, capsule_to({0.25, 0.25, -0.25}), at(0.1, 0.5, 0.5)},
      {"a segment's end in a cube's corner", cube, capsule_to({0.5, 0.5, 0.25}), at(1, 1, 0.75)},
      {"a segment through a cube", cube, capsule_to({2, 0.1, 0.2}), at(0.1, 0.2, 0.3)},
      {"a capsule on a floor", ground(), capsule_to({0.25, 0.25, 0}, 0.1), at(5, 6, 0.1)},
      {"a ball on a quarter of space", quarter_space(), ball_of(0.5), at(0.3, 0.4, 0.0)},
      {"a ball in a cube", cube, ball_of(0.1), at(0.1, 0.2, 0.3)},
      {"cubes that are small beside their radii", with_radius(cube, 1e4), with_radius(cube, 1e4),
       at(0.9, 0.2, 0.3)},
      {"a cube upright on another's edge", cube, hard::rotated(cube, turned(Vec3::UnitX(), 0.3)),
       at(0.2, 0.5, 1.0)},
  };
}

TEST(EveryStart, OfPairsThatTouchOrOverlapLeadsToTheTruth) {
  for (const TouchingPair& pair : touching_pairs()) {
    DistanceJudge judge(pair.a, pair.b);
    ASSERT_EQ(judge.refusal(), "") << pair.name;
    EXPECT_EQ(test::fault_from_any_start(judge, Pose{}, pair.pose_b), "") << pair.name;
    DistanceJudge swapped(pair.b, pair.a);
    EXPECT_EQ(test::fault_from_any_start(swapped, pair.pose_b, Pose{}), "")
        << pair.name << ", swapped";
  }
}

// The boxes have no faces across the axes of their frames, so their corners' facets are compared.
TEST(EveryStart, WithoutAStateIsAtTheFeaturesOfLevelBodiesThatFaceEachOther) {
  const Eigen::Quaterniond turn = turned(Vec3::UnitZ(), 0.5);
  const Body box = hard::rotated(hard::box({0.5, 0.4, 0.3}), turn);
  DistanceJudge judge(box, box);
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const Vec3 gap = 0.25 * Vec3(x, y, z);
        if (gap.isZero()) continue;
        const Pose b{turn * (gap + Vec3(1.0 * x, 0.8 * y, 0.6 * z)), {1, 0, 0, 0}};
        TrackingState state;
        const DistanceResult r = judge.ask(Pose{}, b, state);
        EXPECT_NEAR(r.distance, gap.norm(), 1e-15) << gap.transpose();
        const auto faults = judge.faults(r, judge.truth(Pose{}, b), Pose{}, b);
        EXPECT_TRUE(faults.empty()) << gap.transpose() << ": " << faults.front();
        const int components = (x != 0.0) + (y != 0.0) + (z != 0.0);
        const FeatureKind kinds[] = {FeatureKind::kFacet, FeatureKind::kEdge, FeatureKind::kVertex};
        EXPECT_EQ(state.a.kind, kinds[components - 1]) << gap.transpose();
        EXPECT_LE(r.iterations, 4) << gap.transpose();
      }
    }
  }
}

// A point may lie in a facet's plane, and yet so far out that its square overflows.
TEST(EveryStart, HoldsAtPointsThatAreInTheirPlaneAndFarFromTheirFacet) {
  const Body box = hard::box({1.0, 0.5, 0.25});
  DistanceJudge judge(box, box);
  for (const Pose& beside : {at(2.1, 0.2, 0.1), at(0.3, 1.1, 0.1), at(0.3, 0.2, 0.6)}) {
    const oracle::ExactDistance truth = judge.truth(Pose{}, beside);
    for (std::int32_t facet = 0; facet < 6; ++facet) {
      for (std::int32_t other = 0; other < 6; ++other) {
        TrackingState state;
        const auto far_out = [](const Facet& f, std::int32_t index) {
          const Vec3 across = f.normal.cwiseAbs().isApprox(Vec3::UnitX())
                                  ? Vec3(f.offset * f.normal.x(), 1e200, 0.0)
                                  : Vec3(1e200, 0.0, 0.0) + f.offset * f.normal;
          return TrackingState::Side{FeatureKind::kFacet, false, index, across};
        };
        state.a = far_out(judge.a().facets[facet], facet);
        state.b = far_out(judge.b().facets[other], other);
        const auto faults = judge.faults(judge.ask(Pose{}, beside, state), truth, Pose{}, beside);
        EXPECT_TRUE(faults.empty()) << facet << ' ' << other << ": " << faults.front();
      }
    }
  }
}

}  // namespace
}  // namespace clearance
