// The directions that two active features suggest. Oracle: the features of a cube.
#include "core/active_set/certificate.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <vector>

#include "core/shapes.hpp"
#include "tests/core/active_set/cube_features.hpp"
#include "tests/shared/made.hpp"

namespace clearance::test {
namespace {

std::vector<Separator> list_of(const ActiveFeature& a, const ActiveFeature& b) {
  const Separators list = separators(a, b);
  return {list.begin(), list.end()};
}

// The pose of a body that is only moved.
RelativePose moved_by(const Vec3& translation) {
  RelativePose pose = relative_pose(Pose{}, Pose{});
  pose.translation = translation;
  return pose;
}

TEST(Separators, OfPointsThatCoincideAreTheNormalsOfFacetsAlone) {
  const ConvexBody body = cube(), tip = made(point({0.5, 0.5, 0.5}, 0.0));
  const RelativePose here = moved_by(Vec3::Zero());
  const ActiveFeature b = active(tip, &here, FeatureKind::kVertex, 0);
  const ActiveFeature corner = active(body, nullptr, FeatureKind::kVertex,
                                      vertex_at(body, {0.5, 0.5, 0.5}), {0.5, 0.5, 0.5});
  EXPECT_TRUE(list_of(corner, b).empty());
  const std::int32_t top = facet_towards(body, Vec3::UnitZ());
  const auto list = list_of(active(body, nullptr, FeatureKind::kFacet, top, {0.5, 0.5, 0.5}), b);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].normal, Vec3::UnitZ());
  EXPECT_EQ(list[0].facet_of_a, top);
}

TEST(Separators, OfPointsSoFarApartThatTheirDistanceOverflowsAreNone) {
  const ConvexBody tip = made(point(Vec3::Zero(), 0.0));
  const ActiveFeature a = active(tip, nullptr, FeatureKind::kVertex, 0);
  for (const auto& [far, count] : {std::pair{1e150, 1U}, {1e200, 0U}}) {
    const RelativePose there = moved_by({far, 0.0, 0.0});
    const auto list = list_of(a, active(tip, &there, FeatureKind::kVertex, 0));
    ASSERT_EQ(list.size(), count) << far;
    for (const Separator& found : list) EXPECT_EQ(found.normal, Vec3::UnitX());
  }
}

}  // namespace
}  // namespace clearance::test
