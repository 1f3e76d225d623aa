// Boxes that touch at their corners and edges while one of them rotates; then they part, or one
// sinks into the other. Oracles: the exact distance, and the construction, which translates a box
// along the normal by its distance.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/feature_tracking/feature_pair.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/poses.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/repeats.hpp"

namespace clearance {
namespace {

const std::uint64_t kContactSeeds = repeats(60);
constexpr int kContactSteps = 60;

struct TouchingBoxes {
  Vec3 half_a, half_b;
  std::vector<std::pair<Pose, Pose>> poses;

  [[nodiscard]] DistanceJudge judge() const { return {hard::box(half_a), hard::box(half_b)}; }
};

// `gap`, m, at each step: 0 is contact, up to the rounding of the poses.
template <class Gap>
TouchingBoxes touching_boxes(std::uint64_t seed, const Gap& gap) {
  Random random(seed);
  const auto half = [&] { return random.uniform(0.1, 0.5); };
  TouchingBoxes made{{half(), half(), half()}, {half(), half(), half()}, {}};
  const DistanceJudge judge = made.judge();
  const Pose a = random.pose(2.0);
  const Vec3 axis = random.direction();
  Pose b{a.position + 2.0 * random.direction(), random.rotation()};
  for (int k = 0; k < kContactSteps; ++k) {
    b.orientation = (test::turned(axis, 0.01) * b.orientation).normalized();
    TrackingState cold;
    const DistanceResult apart = judge.ask(a, b, cold);
    Pose resting = b;
    resting.position -= (apart.distance - gap(k)) * (a.orientation * apart.normal);
    made.poses.push_back({a, resting});
  }
  return made;
}

TEST(CornerContacts, AreCertifiedByTheirFeatures) {
  std::array<int, kFeaturePairs> of_kind{};
  int all = 0, at_once = 0;
  for (std::uint64_t seed = 0; seed < kContactSeeds; ++seed) {
    const TouchingBoxes boxes = touching_boxes(seed, [](int) { return 0.0; });
    DistanceJudge judge = boxes.judge();
    TrackingState state;
    for (std::size_t k = 0; k < boxes.poses.size(); ++k) {
      const auto& [a, b] = boxes.poses[k];
      const DistanceResult tracked = judge.ask(a, b, state);
      const bool touch = tracked.status == DistanceStatus::kTouching;
      all += touch;
      at_once += touch && tracked.path == DistancePath::kPenetration;
      if (state.a.kind <= FeatureKind::kFacet && state.b.kind <= FeatureKind::kFacet) {
        ++of_kind[static_cast<std::size_t>(feature_pair(state))];
      }
      if (k % 20 != seed % 20) continue;
      TrackingState forgotten;
      const oracle::ExactDistance truth = judge.truth(a, b);
      for (const DistanceResult& result : {tracked, judge.ask(a, b, forgotten)}) {
        EXPECT_NEAR(result.normal.norm(), 1.0, 1e-14);
        for (const std::string& fault : judge.faults(result, truth, a, b)) {
          ADD_FAILURE() << "seed " << seed << " step " << k << ": " << fault;
        }
      }
    }
  }
  EXPECT_GT(all, 0.9 * static_cast<double>(kContactSeeds * kContactSteps));
  EXPECT_GT(at_once, 0.95 * all);
  for (const FeaturePair kind : {FeaturePair::kVertexVertex, FeaturePair::kVertexEdge,
                                 FeaturePair::kEdgeVertex, FeaturePair::kEdgeEdge}) {
    EXPECT_GT(of_kind[static_cast<std::size_t>(kind)], 100) << static_cast<int>(kind);
  }
}

TEST(CornerContacts, BoundsHoldWhileTheBoxesPartAndSink) {
  for (const double away : {3e-16, 1e-15, 4e-15, 1e-13, 1e-9, 1e-5, 1e-2}) {
    for (std::uint64_t seed = 0; seed < kContactSeeds / 6; ++seed) {
      const auto gap = [&](int k) { return std::array{0.0, away, 0.0, -away}[k % 4]; };
      const TouchingBoxes boxes = touching_boxes(100 + seed, gap);
      DistanceJudge judge = boxes.judge();
      TrackingState state;
      for (std::size_t k = 0; k < boxes.poses.size(); ++k) {
        const auto& [a, b] = boxes.poses[k];
        const DistanceResult result = judge.ask(a, b, state);
        if (k % 15 >= 4) continue;
        for (const std::string& fault : judge.faults(result, judge.truth(a, b), a, b)) {
          ADD_FAILURE() << "seed " << seed << " step " << k << ", " << away << " m: " << fault;
        }
      }
    }
  }
}

}  // namespace
}  // namespace clearance
