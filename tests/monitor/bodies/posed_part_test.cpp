#include "monitor/bodies/posed_part.hpp"

#include <gtest/gtest.h>

#include "tests/monitor/tick/small_cells.hpp"

namespace clearance {
namespace {

PosedPart placed(const Scene& scene, const Pose& world_from_object) {
  PosedPart part = parts_of(scene).front();
  TrackedObject object;
  EXPECT_FALSE(
      take(scene.objects.front(), test::sample(0, world_from_object, 1), 1, {1, 0}, object));
  advance(scene.objects.front(), 1, object);
  place(object, part);
  return part;
}

TEST(PosedPart, NoPointIsFartherFromItsExactPlaceThanTheErrorSays) {
  Random random(11);
  for (int i = 0; i < 5000; ++i) {
    const double scale = std::pow(10.0, random.uniform(-3.0, 4.0));
    const Scene scene =
        test::cell_of({test::moving("arm", {test::capsule(1.0, 0.1, random.pose(scale))})});
    const Pose pose = random.pose(scale);
    const PosedPart part = placed(scene, pose);
    for (const Vec3& anchor : part.shape->anchors) {
      const test::LongVec point = anchor.cast<long double>();
      const test::LongVec exact = test::exactly(pose, test::exactly(part.object_from_part, point));
      const long double off = (test::exactly(part.world_from_part, point) - exact).norm();
      ASSERT_LE(off, part.shift_error + part.turn_error * part.extent);
      ASSERT_LE((exact - pose.position.cast<long double>()).norm() + 0.1L, part.bounding_radius);
      const long double from_centre =
          (exact - part.sphere_in_world.centre.cast<long double>()).norm();
      ASSERT_LE(from_centre + 0.1L, part.sphere_in_world.radius);
    }
  }
}

TEST(PosedPart, WithoutAnOffsetHasThePoseOfItsObjectToTheBit) {
  const Scene scene = test::cell_of({test::moving("arm", {test::ball(0.1)})});
  const Pose pose = Random(12).pose(3.0);
  const PosedPart part = placed(scene, pose);
  EXPECT_EQ(part.world_from_part.position, pose.position);
  EXPECT_EQ(part.world_from_part.orientation.coeffs(), pose.orientation.coeffs());
  EXPECT_EQ(placing_error(part, part), 0.0);
}

TEST(PosedPart, ShiftedPartsOfOneObjectStayParallelToTheBit) {
  const Scene scene = test::cell_of({test::moving("arm", {test::ball(0.1, test::at(1, 2, 3))})});
  const Pose pose = Random(13).pose(3.0);
  EXPECT_EQ(placed(scene, pose).world_from_part.orientation.coeffs(), pose.orientation.coeffs());
}

TEST(PosedPart, ATiltedFloorCostsABoundedPartOnlyRounding) {
  Random random(14);
  const Scene scene = test::cell_of({test::moving("floor", {test::floor(random.pose(1.0))})});
  const Scene other = test::cell_of({test::moving("ball", {test::ball(0.1)})});
  const PosedPart tilted = placed(scene, random.pose(1.0));
  EXPECT_GT(tilted.turn_error, 0.0);
  EXPECT_LT(placing_error(tilted, placed(other, random.pose(5.0))), 1e-12);
}

// Each error counts in full, and a rotation by the smaller one of two arms.
TEST(PosedPart, ErrorOfTwoPartsIsTheSumOfTheirErrors) {
  const auto error = [](const std::array<double, 2>& shift, const std::array<double, 2>& turn) {
    std::array<PosedPart, 2> parts;
    for (std::size_t i = 0; i < 2; ++i) {
      parts[i].shift_error = shift[i];
      parts[i].turn_error = turn[i];
      parts[i].extent = i == 0 ? 2.0 : 8.0;
      parts[i].world_from_part = test::at(3.0 * static_cast<double>(i), 0, 0);
    }
    return placing_error(parts[0], parts[1]);
  };
  EXPECT_GE(error({0.5, 0}, {0, 0}), 0.5);
  EXPECT_GE(error({0, 0.25}, {0, 0}), 0.25);
  EXPECT_GE(error({0, 0}, {0.125, 0}), 0.125 * 2.0);
  EXPECT_GE(error({0, 0}, {0, 0.125}), 0.125 * (3.0 + 2.0)) << "about its origin, the other turns";
  EXPECT_GE(error({0.5, 0.25}, {0.125, 0.125}), 0.5 + 0.25 + 0.25 + 0.625);
  EXPECT_LE(error({0.5, 0.25}, {0.125, 0.125}), 1.0001 * (0.5 + 0.25 + 0.25 + 0.625));
}

}  // namespace
}  // namespace clearance
