#include "config/mesh/parts_cover.hpp"

#include <gtest/gtest.h>

#include <random>

#include "config/decomposition/convex_parts.hpp"
#include "tools/cases/drawn_meshes.hpp"

namespace clearance {
namespace {

ConvexBody box(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> vertices;
  for (int i = 0; i < 8; ++i) {
    vertices.emplace_back((i & 1 ? high : low).x(), (i & 2 ? high : low).y(),
                          (i & 4 ? high : low).z());
  }
  return std::get<ConvexBody>(polyhedron_from_vertices(vertices));
}

TriangleMesh triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{a, b, c}, {{0, 1, 2}}};
}

TEST(Cover, HoldsATriangleThatSeveralPartsShare) {
  const TriangleMesh across = triangle({0.1, 0.1, 0.5}, {2.9, 0.1, 0.5}, {1.5, 0.9, 0.5});
  const std::vector<ConvexBody> boxes{box({0, 0, 0}, {1, 1, 1}), box({2, 0, 0}, {3, 1, 1}),
                                      box({1, 0, 0}, {2, 1, 1})};
  EXPECT_TRUE(cover(boxes, across));
  EXPECT_FALSE(cover({&boxes[0], 2}, across)) << "the middle is missing";
  EXPECT_FALSE(cover({}, across));
}

TEST(Cover, AllowsNoGapThatExceedsRounding) {
  const TriangleMesh across = triangle({0.1, 0.1, 0.5}, {1.9, 0.1, 0.5}, {1.5, 0.9, 0.5});
  for (const double gap : {-1e-3, 0.0, 1e-10, 1e-8, 1e-3}) {
    const std::vector<ConvexBody> boxes{box({0, 0, 0}, {1, 1, 1}), box({1 + gap, 0, 0}, {2, 1, 1})};
    EXPECT_EQ(cover(boxes, across), gap < 2e-9) << gap;
  }
}

// The decomposition certifies that its parts hold the mesh; scaled down, they do not.
TEST(Cover, HoldsOfThePartsOfEveryMeshAndNotOfSmallerOnes) {
  for (const TriangleMesh& mesh : {drawn::l_shape(), drawn::degenerate_l()}) {
    const auto parts = std::get<ConvexParts>(convex_parts(mesh));
    for (const double scale : {1.0, 0.999, 0.5, 0.1}) {
      std::vector<ConvexBody> bodies;
      for (const auto& part : parts.parts) {
        std::vector<Vec3> vertices;
        for (const Vec3& vertex : part) vertices.push_back(scale * vertex);
        bodies.push_back(std::get<ConvexBody>(polyhedron_from_vertices(vertices)));
      }
      EXPECT_EQ(cover(bodies, mesh), scale == 1.0) << scale;
    }
  }
}

// Random triangles against random boxes: a point of the triangle outside of all boxes refutes it.
TEST(Cover, AgreesWithSampledPoints) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto point = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  int covered = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<ConvexBody> boxes;
    for (int i = 0; i < 4; ++i) {
      const Vec3 low = -0.1 * Vec3::Ones() + 0.5 * point();
      boxes.push_back(box(low, low + 0.4 * Vec3::Ones() + 0.6 * point()));
    }
    const Vec3 a = point(), b = point(), c = point();
    const bool says = cover(boxes, triangle(a, b, c));
    covered += says;
    bool all_inside = true;
    for (int k = 0; k < 2000; ++k) {
      double u = unit(random), v = unit(random);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const Vec3 at = a + u * (b - a) + v * (c - a);
      const bool inside = std::ranges::any_of(boxes, [&](const ConvexBody& body) {
        return std::ranges::all_of(body.facets, [&](const Facet& facet) {
          return facet.normal.dot(at) <= facet.offset + 2e-9;
        });
      });
      all_inside = all_inside && inside;
    }
    if (says) {
      EXPECT_TRUE(all_inside) << round;
    }
  }
  EXPECT_GT(covered, 20);
  EXPECT_LT(covered, 280);
}

}  // namespace
}  // namespace clearance
