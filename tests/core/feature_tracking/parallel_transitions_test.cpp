// Level features: whole faces or edges are closest. Oracles: the exact distance and closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/feature_tracking/feature_tracking.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"
#include "tests/shared/vector_widths.hpp"

namespace clearance {
namespace {

using Quat = Eigen::Quaterniond;
using test::turned;

const std::uint64_t kSeeds = repeats(40);

// B above A, which is a box, and moving along it.
struct ParallelPair {
  const char* name;
  FeatureKind kind_a, kind_b;  // kinds of the closest features
  Vec3 half_b{0.5, 0.4, 0.3};
  Quat turn = Quat::Identity();  // rotation of B in frame A
  Vec3 offset{0.0, 0.0, 2.0};    // position of B's centre in frame A
  Vec3 half_a{0.7, 0.6, 0.5};

  [[nodiscard]] DistanceJudge judge() const { return {hard::box(half_a), hard::box(half_b)}; }
};

const ParallelPair kPairs[] = {
    {"facets", FeatureKind::kFacet, FeatureKind::kFacet},
    {"facets that cross",
     FeatureKind::kFacet,
     FeatureKind::kFacet,
     {2.0, 0.1, 0.3},
     turned(Vec3::UnitZ(), 0.7)},
    {"edge on facet",
     FeatureKind::kFacet,
     FeatureKind::kEdge,
     {0.5, 0.4, 0.3},
     turned(Vec3::UnitX(), 0.7)},
    {"facet on edge",
     FeatureKind::kEdge,
     FeatureKind::kFacet,
     {0.5, 0.4, 0.3},
     turned(Vec3::UnitX(), 0.7),
     {0.0, -2.0 * std::sin(0.7), 2.0 * std::cos(0.7)}},
    {"parallel edges",
     FeatureKind::kEdge,
     FeatureKind::kEdge,
     {0.5, 0.4, 0.3},
     Quat::Identity(),
     {0.1, 1.5, 2.0}},
    {"parallel edges, turned round",
     FeatureKind::kEdge,
     FeatureKind::kEdge,
     {0.5, 0.4, 0.3},
     turned(Vec3::UnitZ(), std::acos(-1.0)),
     {0.1, 1.5, 2.0}},
    {"flush boxes of one size", FeatureKind::kFacet, FeatureKind::kFacet, {0.7, 0.6, 0.5}},
};

// Both bodies rotated arbitrarily, B after an additional tilt of the order of rounding.
std::pair<Pose, Pose> anywhere(const ParallelPair& pair, Random& random, double tilt) {
  const Quat world = random.rotation();
  const Vec3 origin = random.in_box(3.0);
  const Quat b = world * (turned(random.direction(), tilt) * pair.turn);
  return {{origin, world}, {origin + world * pair.offset, b}};
}

TEST(ParallelTransitions, SettlesWhatItWasLastTimeInOneStep) {
  for (const ParallelPair& pair : kPairs) {
    DistanceJudge judge = pair.judge();
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      Random random(seed);
      const auto [a, b] = anywhere(pair, random, seed % 2 == 0 ? 0.0 : 1e-16);
      TrackingState state;
      (void)judge.ask(a, b, state);
      EXPECT_EQ(state.a.kind, pair.kind_a) << pair.name << " seed " << seed;
      EXPECT_EQ(state.b.kind, pair.kind_b) << pair.name << " seed " << seed;
      DistanceResult result;
      EXPECT_EQ(track_features({judge.a(), judge.b(), relative_pose(a, b), state}, result),
                TrackingEnd::kCertified)
          << pair.name << " seed " << seed;
      EXPECT_EQ(result.iterations, 1) << pair.name << " seed " << seed;
    }
  }
}

TEST(ParallelTransitions, BoundsHoldAtEveryTilt) {
  for (const ParallelPair& pair : kPairs) {
    DistanceJudge judge = pair.judge();
    TrackingState state;  // left by the previous tilt, a different pose
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      Random random(seed);
      const double tilt = seed % 4 == 0 ? 0.0 : random.log_uniform(1e-17, 1e-9);
      const auto [a, b] = anywhere(pair, random, tilt);
      const DistanceResult result = judge.ask(a, b, state);
      for (const std::string& fault : judge.faults(result, judge.truth(a, b), a, b)) {
        ADD_FAILURE() << pair.name << " seed " << seed << ": " << fault;
      }
    }
  }
}

TEST(ParallelTransitions, HasTheSameBitsAtEveryVectorWidth) {
  for (const ParallelPair& pair : kPairs) {
    const DistanceJudge judge = pair.judge();
    Random random(5);
    const auto [a, b] = anywhere(pair, random, 1e-16);
    TrackingState expected_state;
    const DistanceResult expected = judge.ask(a, b, expected_state);
    for (const std::int64_t width : vector_widths()) {
      const OnlyWith only(width);
      TrackingState state;
      EXPECT_TRUE(same_bits(judge.ask(a, b, state), expected)) << pair.name;
    }
  }
}

// The motions lead from one side of the other body to the opposite side: over its face, along its
// edge, past its vertex.
TEST(ParallelTransitions, WitnessesMoveNoFasterThanTheBodies) {
  for (const ParallelPair& pair : kPairs) {
    const DistanceJudge judge = pair.judge();
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      Random random(seed);
      const Quat world = random.rotation();
      const double angle = random.uniform(0.0, 6.3), step = 0.01;
      const Vec3 shift = step * Vec3(std::cos(angle), std::sin(angle), 0.0);
      TrackingState state;
      Vec3 last = Vec3::Zero();
      for (int k = -60; k < 60; ++k) {
        const Pose b{world * (pair.offset + k * shift), world * pair.turn};
        const DistanceResult result = judge.ask({Vec3::Zero(), world}, b, state);
        if (k > -60) {
          EXPECT_LE((result.point_on_a - last).norm(), step + 1e-13)
              << pair.name << " seed " << seed << " step " << k;
        }
        last = result.point_on_a;
      }
    }
  }
}

// The points may move by an ulp or two of coordinates of a few metres per query.
TEST(ParallelTransitions, StandsStillWhileTheBodiesDo) {
  for (const ParallelPair& pair : kPairs) {
    const DistanceJudge judge = pair.judge();
    Random random(7);
    const auto [a, b] = anywhere(pair, random, 0.0);
    TrackingState state;
    const Vec3 first = judge.ask(a, b, state).point_on_a;
    for (int k = 0; k < 1000; ++k) (void)judge.ask(a, b, state);
    EXPECT_LE((judge.ask(a, b, state).point_on_a - first).norm(), 1000 * 0x1p-50) << pair.name;
  }
}

// Halfway between points of bodies of 1e84 m, rounding once left a point half a metre inside a box.
// The bounds for boxes face to face were then 0.5 m too high.
TEST(ParallelTransitions, HoldsWithTheStateOfAPairThatIsFarLarger) {
  DistanceJudge judge(hard::box({1.0, 0.5, 0.25}), hard::box({1.0, 0.5, 0.25}));
  const Pose beside{{0.0, -1.1, -0.14}, Quat::Identity()};
  const oracle::ExactDistance truth = judge.truth(Pose{}, beside);
  for (double far = 1.0; far < 1e300; far *= 8.0) {
    for (const FeatureKind kind : {FeatureKind::kVertex, FeatureKind::kEdge, FeatureKind::kFacet}) {
      TrackingState state;
      state.a = {kind, false, 3, Vec3(-far, 0.7 * far, far)};
      state.b = {kind, false, 2, Vec3(far, 0.2 * far, -far)};
      const DistanceResult result = judge.ask(Pose{}, beside, state);
      const auto faults = judge.faults(result, truth, Pose{}, beside);
      EXPECT_TRUE(faults.empty()) << far << ": " << faults.front();
    }
  }
}

}  // namespace
}  // namespace clearance
