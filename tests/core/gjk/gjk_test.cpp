// GJK alone, without bounds from the active-set iteration before it. Oracle: the closed form of
// cubes that face each other. All their figures are exact in doubles, so each bound differs from
// the distance by the whole error bound.
#include "core/gjk/gjk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/shapes.hpp"
#include "tests/shared/made.hpp"

namespace clearance {
namespace {

struct Refined {
  DistanceResult result;
  Precision precision;
};

// Cubes of 1 m, the second at `place`. The features begin at vertices.
Refined refined(const Vec3& place) {
  const ConvexBody cube = test::cube();
  const RelativePose pose = relative_pose(Pose{}, Pose{.position = place});
  ActiveFeature a(cube, nullptr), b(cube, &pose);
  a.place_at_vertex(0);
  b.place_at_vertex(0);
  Refined found{{}, precision(cube, cube, pose, place.norm())};
  found.result.lower = -kInfinity;
  found.result.upper = found.result.distance = kInfinity;
  refine(a, b, pose, found.precision, found.result);
  return found;
}

TEST(Refine, WidensBothBoundsByTheErrorBound) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      for (const double gap : {0x1p-10, 1.0, 0x1p10}) {
        const auto [r, p] = refined(side * (1.0 + gap) * Vec3::Unit(axis));
        EXPECT_TRUE(p.converged(r.upper - r.lower));
        EXPECT_EQ(r.distance, gap);
        EXPECT_GT(p.error_bound, 0.0);
        EXPECT_EQ(r.lower, gap - p.error_bound);
        EXPECT_EQ(r.upper, gap + p.error_bound);
        EXPECT_EQ(r.normal, side * Vec3::Unit(axis));
      }
    }
  }
}

// A quarter of the space has one vertex, with which the search begins, and rays. The points below
// the cube are far from it.
TEST(Refine, FindsClosestPointsOfAnUnboundedBodyThatAreFarFromItsVertices) {
  const std::array rows{HalfSpace{Vec3::UnitZ(), 0.0}, HalfSpace{-Vec3::UnitX(), 1.0},
                        HalfSpace{-Vec3::UnitY(), 1.0}};
  const ConvexBody floor = test::made(polyhedron_from_halfspaces(rows)), cube = test::cube();
  ASSERT_EQ(floor.vertices.size(), 1u);
  for (const Vec3& place : {Vec3(0, 0, 1.5), Vec3(4, 0, 1.5), Vec3(3, 5, 1.5), Vec3(64, 1, 1.5)}) {
    const RelativePose pose = relative_pose(Pose{}, Pose{.position = place});
    ActiveFeature a(floor, nullptr), b(cube, &pose);
    a.place_at_vertex(0);
    b.place_at_vertex(0);
    const Precision p = precision(floor, cube, pose, place.norm());
    DistanceResult r;
    r.lower = -kInfinity;
    r.upper = r.distance = kInfinity;
    refine(a, b, pose, p, r);
    EXPECT_TRUE(p.converged(r.upper - r.lower)) << place.transpose();
    EXPECT_LE(r.lower, 1.0);
    EXPECT_GE(r.upper, 1.0);
    EXPECT_LE(r.upper - r.lower, 2.0 * p.error_bound + p.gap_tolerance);
  }
}

// The search begins with a point of the unbounded body that is far out.
TEST(Refine, BeginsWithAnAnchorOfTheSecondBodyInsteadOfAPointThatIsFarOut) {
  const std::array rows{HalfSpace{Vec3::UnitZ(), 0.0}, HalfSpace{-Vec3::UnitX(), 1.0},
                        HalfSpace{-Vec3::UnitY(), 1.0}};
  const ConvexBody floor = test::made(polyhedron_from_halfspaces(rows)), cube = test::cube();
  for (const bool floor_is_first : {true, false}) {
    const ConvexBody &first = floor_is_first ? floor : cube,
                     &second = floor_is_first ? cube : floor;
    const Vec3 place = (floor_is_first ? 1.0 : -1.0) * Vec3(3, 5, 1.5);
    const RelativePose pose = relative_pose(Pose{}, Pose{.position = place});
    ActiveFeature a(first, nullptr), b(second, &pose);
    a.place_at_vertex(0);
    b.place_at_vertex(0);
    const auto top = std::ranges::find(floor.facets, Vec3(Vec3::UnitZ()), &Facet::normal);
    ASSERT_NE(top, floor.facets.end());
    const auto facet = static_cast<std::int32_t>(top - floor.facets.begin());
    (floor_is_first ? a : b).place_on_facet(facet, Vec3(1e6, 1e6, 0.0));
    const Precision p = precision(first, second, pose, place.norm());
    DistanceResult r;
    r.lower = -kInfinity;
    r.upper = r.distance = kInfinity;
    refine(a, b, pose, p, r);
    EXPECT_TRUE(p.converged(r.upper - r.lower)) << floor_is_first;
    EXPECT_LE(r.lower, 1.0);
    EXPECT_GE(r.upper, 1.0);
  }
}

}  // namespace
}  // namespace clearance
