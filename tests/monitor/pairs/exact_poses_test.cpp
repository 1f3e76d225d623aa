// A query has the product of an object's pose and a part's offset, rounded. Its bounds are widened
// for the exact product.
#include <gtest/gtest.h>

#include "monitor/pairs/evaluate_pair.hpp"
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

}  // namespace
}  // namespace clearance
