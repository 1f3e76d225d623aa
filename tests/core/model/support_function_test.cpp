// The support value of a body: the result of hill climbing compared with all vertices.
#include "core/model/support_function.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "core/shapes.hpp"
#include "tests/shared/hard_bodies.hpp"
#include "tests/shared/made.hpp"
#include "tests/shared/random.hpp"

namespace clearance {
namespace {

// Along a facet's normal, all vertices of the facet are level within rounding, and only one is the
// support point. A bound from another vertex would be too low.
TEST(Support, IsTheFarthestVertexAlsoWhereManyEdgesAreOrthogonalWithinRounding) {
  Random random(1);
  for (const auto& of : {hard::facet_ball(10), hard::dual_ball(10)}) {
    const ConvexBody body = test::made(of);
    const auto expect_support_point = [&](const Vec3& m) {
      EXPECT_EQ(support(body, m).value, support_by_scan(body, m).value);
    };
    for (const Facet& facet : body.facets) {
      expect_support_point(facet.normal);
      for (const double tilt : {1e-16, 1e-15, 1e-14}) {
        expect_support_point((facet.normal + tilt * random.direction()).normalized());
      }
    }
    for (const Edge& edge : body.edges) {
      if (edge.facet[0] == kNone) continue;
      const Vec3 between = body.facets[edge.facet[0]].normal + body.facets[edge.facet[1]].normal;
      expect_support_point(between.normalized());
    }
  }
}

// A prism and two wedges, one of them nearly flat, with directions of their recession cones.
TEST(Support, AlongRaysIsAtLeastThatOfEachPointWithinAndLittleAlongAFacet) {
  struct Unbounded {
    std::vector<HalfSpace> rows;
    std::vector<Vec3> directions;
  };
  std::vector<Unbounded> bodies{
      {{{{1, 1, 0}, 0.5}, {{-1, 1, 0}, 0.5}, {{0, -1, 0}, 0.5}}, {{0, 0, 1}, {0, 0, -1}}}};
  for (const double slope : {1.0, 1e-5}) {
    bodies.push_back({{{{slope, 0, 1}, 0.0}, {{-slope, 0, 1}, 0.0}},
                      {{0, 1, 0}, {0, -1, 0}, {0, 0, -1}, {1, 0, -slope}, {-1, 0, -slope}}});
  }
  constexpr double kWithin = 8.0;
  Random random(2);
  for (const auto& [rows, directions] : bodies) {
    const ConvexBody body = test::made(polyhedron_from_halfspaces(rows));
    for (const Facet& facet : body.facets) {
      EXPECT_LE(support_along_rays(body, facet.normal, kWithin), 1e-12);
      for (const double tilt : {1e-15, 1e-3, 1.0}) {
        const Vec3 m = (facet.normal + tilt * random.direction()).normalized();
        for (const Vec3& along : directions)
          EXPECT_GE(support_along_rays(body, m, kWithin), m.dot(kWithin * along.normalized()));
      }
    }
  }
}

}  // namespace
}  // namespace clearance
