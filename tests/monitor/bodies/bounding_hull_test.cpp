// The hulls themselves are tested in tests/core/construction/enclosing_polyhedron_test.cpp. These
// tests check which parts get one.
#include "monitor/bodies/bounding_hull.hpp"

#include <gtest/gtest.h>

#include <variant>

#include "core/shapes.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

Part box_at(double half, const Vec3& position) {
  return {"box", test::made(box(Vec3::Constant(half))), {.position = position}};
}

Object object_of(std::vector<Part> parts) {
  Object object;
  object.parts = std::move(parts);
  return object;
}

TEST(BoundingHull, IsMadeOfObjectsOfSeveralBoundedPartsOrOfOnePartOfManyFacets) {
  Scene scene;
  const Part floor{"floor", test::half_space(Vec3::UnitZ(), 0.0), {}};
  scene.objects = {object_of({box_at(1.0, Vec3::Zero()), box_at(1.0, Vec3::UnitX())}),
                   object_of({box_at(1.0, Vec3::Zero())}), object_of({}),
                   object_of({box_at(1.0, Vec3::Zero()), floor}),
                   object_of({{"ball", test::made(hard::facet_ball(10)), {}}})};
  ASSERT_GT(scene.objects[4].parts[0].shape.facets.size(), kFineFacets);
  const auto hulls = bounding_hulls(scene);
  ASSERT_EQ(hulls.size(), 5u);
  EXPECT_TRUE(hulls[0]);
  EXPECT_FALSE(hulls[1]);
  EXPECT_FALSE(hulls[2]);
  EXPECT_FALSE(hulls[3]);
  ASSERT_TRUE(hulls[4]);
  EXPECT_LE(hulls[4]->facets.size(), kFineFacets / 2);
}

TEST(BoundingHull, IsSharedByObjectsOfTheSamePartsOnly) {
  Scene scene;
  const auto pair = [](double half, double apart) {
    return object_of({box_at(half, Vec3::Zero()), box_at(half, apart * Vec3::UnitX())});
  };
  scene.objects = {pair(1.0, 3.0), pair(0.5, 3.0), pair(1.0, 4.0), pair(1.0, 3.0)};
  scene.objects[0].name = "one";
  scene.objects[3].name = "other";
  Part turned = box_at(1.0, 3.0 * Vec3::UnitX());
  turned.object_from_part.orientation = Eigen::Quaterniond(0.6, 0.8, 0.0, 0.0);
  scene.objects.push_back(object_of({box_at(1.0, Vec3::Zero()), turned}));
  const auto hulls = bounding_hulls(scene);
  EXPECT_EQ(hulls[0], hulls[3]);
  for (const std::size_t other : {1u, 2u, 4u}) EXPECT_NE(hulls[0], hulls[other]) << other;
}

}  // namespace
}  // namespace clearance
