// The results of a batch compared with exact distances.
#include <gtest/gtest.h>

#include "core/batch.hpp"
#include "tests/shared/distance_judge.hpp"
#include "tests/shared/hard_cases.hpp"

namespace clearance {
namespace {

TEST(DistanceBatch, BoundsHoldAgainstTheExactTruth) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Random random(seed);
    const hard::HardMotion m = hard::motion_families()[0].make(random, 40);
    DistanceJudge judge(m.a, m.b);
    const ConvexBody* const bodies[] = {&judge.a(), &judge.b()};
    const BodyPair pairs[] = {{0, 1}};
    DistanceBatch batch(bodies, pairs);
    for (const auto& [pose_a, pose_b] : m.poses) {
      const Pose poses[] = {pose_a, pose_b};
      const DistanceResult result = batch.evaluate(poses)[0];
      const auto faults = judge.faults(result, judge.truth(pose_a, pose_b), pose_a, pose_b);
      EXPECT_TRUE(faults.empty()) << m.note << " seed " << seed << ": " << faults.front();
    }
  }
}

TEST(DistanceBatch, OfNoPairsGivesNoResults) {
  DistanceBatch batch({}, {});
  EXPECT_TRUE(batch.evaluate({}).empty());
}

}  // namespace
}  // namespace clearance
