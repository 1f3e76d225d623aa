// Normals for pictures of meshes: flat faces stay flat, and round ones become round.
#include "monitor/visual/smooth_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace clearance::test {
namespace {

TriangleMesh cube() {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.vertices.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// A sphere of unit radius in rings and sectors.
TriangleMesh sphere(std::uint32_t rings, std::uint32_t sectors) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= rings; ++i) {
    for (std::uint32_t j = 0; j < sectors; ++j) {
      const double polar = M_PI * i / rings, around = 2.0 * M_PI * j / sectors;
      mesh.vertices.emplace_back(std::sin(polar) * std::cos(around),
                                 std::sin(polar) * std::sin(around), std::cos(polar));
    }
  }
  for (std::uint32_t i = 0; i < rings; ++i) {
    for (std::uint32_t j = 0; j < sectors; ++j) {
      const std::uint32_t a = i * sectors + j, b = i * sectors + (j + 1) % sectors;
      mesh.triangles.push_back({a, a + sectors, b});
      mesh.triangles.push_back({b, a + sectors, b + sectors});
    }
  }
  return mesh;
}

TEST(SmoothMesh, ACubeKeepsItsEdges) {
  const BodyMesh found = smooth_mesh(cube());
  EXPECT_EQ(found.positions.size(), 24u);
  ASSERT_EQ(found.triangles.size(), 12u);
  for (std::size_t i = 0; i < found.positions.size(); ++i) {
    const Vec3 outward = found.positions[i] - Vec3::Constant(0.5);
    EXPECT_DOUBLE_EQ(found.normals[i].cwiseAbs().maxCoeff(), 1.0);
    EXPECT_NEAR(found.normals[i].dot(outward), 0.5, 1e-12);
  }
}

TEST(SmoothMesh, ASphereHasRadialNormalsAndEachVertexOnce) {
  const BodyMesh found = smooth_mesh(sphere(18, 36));
  for (std::size_t i = 0; i < found.positions.size(); ++i) {
    if (std::abs(found.positions[i].z()) > 0.999) continue;
    EXPECT_GT(found.normals[i].dot(found.positions[i]), 0.99);
  }
  // The 17 rings between the poles, and at each pole the corner of every sector's triangle.
  EXPECT_EQ(found.positions.size(), 17u * 36u + 2u * 36u);
}

TEST(SmoothMesh, TrianglesWithoutAreaAreLeftOut) {
  TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 1, 1});
  mesh.vertices.emplace_back(0.5, 0, 0);
  mesh.triangles.push_back({0, 8, 1});
  const BodyMesh found = smooth_mesh(mesh);
  EXPECT_EQ(found.triangles.size(), 12u);
  for (const Vec3& normal : found.normals) EXPECT_NEAR(normal.norm(), 1.0, 1e-12);
}

}  // namespace
}  // namespace clearance::test
