// Bounds of the pairs that a tick does not update, and a proof that the check of the invariant can
// fail.
#include "monitor/schedule/untouched_pairs.hpp"

#include <gtest/gtest.h>

#include "monitor/schedule/broad_phase.hpp"
#include "monitor/schedule/culling.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

TEST(UntouchedPairs, AreNoNearerThanTheHorizonWhateverIsNotObservedOfOthers) {
  const UntouchedPairs untouched{
      .any = true, .horizon = 0.5, .most_unobserved = 0.1, .most_displaced = 0.2};
  EXPECT_EQ(untouched.all().now, 0.5);
  EXPECT_EQ(untouched.all().since, 0.5);
  EXPECT_EQ(untouched.waiting().now, kInfinity) << "no pair waits";
}

TEST(UntouchedPairs, MayHaveBeenAnywhereBetweenTwoTicksAfterADiscontinuity) {
  const UntouchedPairs untouched{.any = true, .horizon = 0.5, .most_displaced = kInfinity};
  EXPECT_EQ(untouched.all().now, 0.5);
  EXPECT_EQ(untouched.all().since, -kInfinity);
}

TEST(UntouchedPairs, ThatWaitAreNoNearerThanTheirBoundLessTheUnobservedMotionOfAnyTwo) {
  const UntouchedPairs untouched{.any = true,
                                 .horizon = 0.5,
                                 .waiting_lower = 0.45,
                                 .most_unobserved = 0.1,
                                 .most_displaced = 0.2};
  EXPECT_NEAR(untouched.all().now, 0.35, 1e-12);
  EXPECT_LE(untouched.all().now, 0.35);
  EXPECT_NEAR(untouched.all().since, 0.25, 1e-12);
}

TEST(UntouchedPairs, ThatWaitBoundAllOfThem) {
  const UntouchedPairs untouched{.any = true, .horizon = 0.5, .waiting_lower = 0.25};
  EXPECT_NEAR(untouched.waiting().now, 0.25, 1e-12);
  EXPECT_NEAR(untouched.all().now, 0.25, 1e-12);
}

TEST(UntouchedPairs, GetTheMotionThatIsNotObservedFromTheTick) {
  const Scene scene =
      test::cell_of(std::vector<Object>(2, test::moving("ball", {test::ball(0.1)})));
  const std::vector<PosedPart> parts = parts_of(scene);
  const PairTable table(scene, parts);
  const ZoneLevels levels(scene);
  const Culling culling(scene, parts, table, levels, {0.0, 0.0}, {}, refresh_share(scene));
  const UntouchedPairs untouched =
      culling.untouched({.changed = {}, .most_unobserved = 0.1, .most_displaced = 0.2});
  EXPECT_FALSE(untouched.any) << "no pair is known yet";
  EXPECT_EQ(untouched.most_unobserved, 0.1);
  EXPECT_EQ(untouched.most_displaced, 0.2);
}

TEST(BroadPhaseInvariant, FailsForACulledPairThatIsNearerThanTheHorizon) {
  const Scene scene =
      test::cell_of(std::vector<Object>(2, test::moving("ball", {test::ball(0.1)})));
  const std::vector<PosedPart> parts = parts_of(scene);
  PairTable table(scene, parts);
  std::vector<TrackedObject> objects(2);
  for (TrackedObject& object : objects) object.input.has_value = true;
  const ZoneLevels levels(scene);
  BroadPhase broad_phase(scene, parts, table, levels, {0.0, 0.0}, {}, 100);
  const std::vector<std::uint32_t> changed{0, 1};
  broad_phase.begin(OpenTick(objects, parts, 1, table), changed);
  broad_phase.clear_activated();
  broad_phase.move_horizon(0.5);
  EXPECT_TRUE(broad_phase.may_be_culled(0, 0.1)) << "it is active";
  ASSERT_TRUE(broad_phase.cull(0, 1.0));
  EXPECT_TRUE(broad_phase.may_be_culled(0, 1.0));
  EXPECT_FALSE(broad_phase.may_be_culled(0, 0.4));
}

}  // namespace
}  // namespace clearance
