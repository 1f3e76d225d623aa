// A query has the product of an object's pose and a part's offset, rounded. Its bounds are widened
// for the exact product.
#include <gtest/gtest.h>

#include <array>

#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/tick/monitor.hpp"
#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

TEST(BoundsForExactPoses, AreWidenedByTheErrorOfPlacingOnBothSides) {
  const Scene scene =
      test::cell_of({test::moving("far", {test::ball(0.1, test::at(1.0, 2.0, 3.0))}),
                     test::moving("near", {test::ball(0.1)})});
  std::vector<PosedPart> parts = parts_of(scene);
  Pose turned = test::at(1e6, 0, 0);
  turned.orientation = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec3::UnitZ()));
  place_at(turned, parts[0]);
  place_at(test::at(1e6, 0, 9), parts[1]);
  const double error = placing_error(parts[0], parts[1]);
  ASSERT_GT(error, 1e-10);
  DistanceResult found;
  found.lower = 4.0;
  found.upper = 5.0;
  const DistanceBounds bounds = for_exact_poses(found, parts[0], parts[1]);
  EXPECT_LE(bounds.lower, 4.0 - error);
  EXPECT_GE(bounds.upper, 5.0 + error);
  EXPECT_NEAR(bounds.lower, 4.0 - error, 1e-14);
  EXPECT_NEAR(bounds.upper, 5.0 + error, 1e-14);
}

// Two balls on a line, each of which may be 1 cm off. Far from the origin, the places of parts are
// not exact.
TEST(BoundsWithStatedErrors, HoldForBallsApartInTouchInContactAndAtOnePlace) {
  constexpr double kError = 0.01, kRadius = 0.25, kGap = 0x1p-33;
  struct Gaps {
    double gap, least, most;
  };
  const Gaps rows[] = {{0.5, 0.48, 0.52},
                       {kGap, kGap - 0.02, kGap + 0.02},
                       {0.0, -0.02, 0.02},
                       {-0.125, -0.145, -0.105},
                       {-0.5, -0.5, -0.48}};
  for (const double from : {0.0, 1e6}) {
    for (const Gaps& row : rows) {
      Scene scene = test::cell_of({test::moving("a", {test::ball(kRadius, test::at(0.5, 0, 0))}),
                                   test::moving("b", {test::ball(kRadius)})});
      for (Object& object : scene.objects) object.place_error.translation = kError;
      scene.pairs[0].publish = true;
      Monitor monitor(scene);
      const Vec3 a(from - 0.5, 0, 0), b(from + 2.0 * kRadius + row.gap, 0, 0);
      for (std::int64_t now = test::kStart; now < test::kStart + 3 * test::kTick;
           now += test::kTick) {
        const std::array samples{test::sample(0, {.position = a}, now),
                                 test::sample(1, {.position = b}, now)};
        const PairReport& pair = monitor.tick(samples, now).pairs[0];
        EXPECT_LE(pair.lower, row.least) << row.gap;
        EXPECT_GE(pair.upper, row.most) << row.gap;
        EXPECT_GE(pair.lower, row.gap - 2.0 * kError - 1e-8) << row.gap;
        EXPECT_LE(pair.upper, row.gap + 2.0 * kError + 1e-3) << row.gap;
        EXPECT_LE(pair.swept_lower, pair.lower);
        EXPECT_NEAR(pair.model_error, 2.0 * kError, 1e-9);
      }
    }
  }
}

// Two floors that face each other never come apart, however they are shifted.
TEST(BoundsWithStatedErrors, OfHalfSpacesThatNothingSeparatesAreMinusInfinity) {
  Scene scene =
      test::cell_of({test::moving("a", {test::floor()}), test::moving("b", {test::floor()})});
  scene.objects[0].place_error.translation = 0.01;
  scene.pairs[0].publish = true;
  Monitor monitor(scene);
  for (std::int64_t now = test::kStart; now < test::kStart + 3 * test::kTick; now += test::kTick) {
    const std::array samples{test::sample(0, {}, now), test::sample(1, {}, now)};
    EXPECT_EQ(monitor.tick(samples, now).pairs[0].lower, -kInfinity);
  }
}

}  // namespace
}  // namespace clearance
