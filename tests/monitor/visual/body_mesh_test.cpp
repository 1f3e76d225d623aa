// Meshes compared with their bodies: every vertex is on the surface, and the mesh is closed and
// oriented outwards.
#include "monitor/visual/body_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <variant>

#include "core/shapes.hpp"

namespace clearance {
namespace {

ConvexBody made(const ShapeResult& shape) { return std::get<ConvexBody>(shape); }

// The enclosed volume, summed over tetrahedra from the triangles to the origin.
double volume(const BodyMesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c]));
  }
  return sum / 6.0;
}

// Returns true if every edge between two points is used once in each direction: no hole, and no
// inverted triangle.
bool is_closed(const BodyMesh& mesh) {
  const auto key = [&](std::uint32_t i) {
    const Vec3& p = mesh.positions[i];
    return std::array{std::llround(p.x() * 1e9), std::llround(p.y() * 1e9),
                      std::llround(p.z() * 1e9)};
  };
  std::map<std::pair<std::array<long long, 3>, std::array<long long, 3>>, int> passed;
  for (const auto& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const auto from = key(triangle[i]), to = key(triangle[(i + 1) % 3]);
      if (from == to) continue;  // a side of zero length, as at a pole
      ++passed[{from, to}];
      --passed[{to, from}];
    }
  }
  return std::ranges::all_of(passed, [](const auto& entry) { return entry.second == 0; });
}

TEST(BodyMesh, OfABoxIsTwelveTrianglesAndTwelveEdges) {
  const BodyMesh mesh = body_mesh(made(box({0.5, 1.0, 1.5})));
  EXPECT_EQ(mesh.triangles.size(), 12u);
  EXPECT_EQ(mesh.edges.size(), 12u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume(mesh), 6.0, 1e-12);
}

TEST(BodyMesh, OfARoundedBoxLiesOnItsSurface) {
  const Vec3 half(0.5, 1.0, 1.5);
  const BodyMesh mesh = body_mesh(made(box(half)), 0.25);
  EXPECT_TRUE(is_closed(mesh));
  for (const Vec3& p : mesh.positions) {
    EXPECT_NEAR((p.cwiseAbs() - half).cwiseMax(0.0).norm(), 0.25, 1e-12);
  }
  // Steiner's formula: the box, its faces, a cylinder along all edges together, and a sphere.
  const double r = 0.25, exact = 6.0 + 22.0 * r + std::numbers::pi * r * r * (1.0 + 2.0 + 3.0) +
                                 4.0 / 3.0 * std::numbers::pi * r * r * r;
  EXPECT_NEAR(volume(mesh), exact, 0.01 * exact);
  EXPECT_LT(volume(mesh), exact);  // chords lie inside the body
}

TEST(BodyMesh, OfACapsuleAndASphereLiesOnThem) {
  const Vec3 start(0.1, 0.2, 0.3), end(0.4, -0.2, 1.3);
  const BodyMesh capsule = body_mesh(made(segment(start, end, 0.2)));
  EXPECT_TRUE(is_closed(capsule));
  for (std::size_t i = 0; i < capsule.positions.size(); ++i) {
    const Vec3 p = capsule.positions[i], along = end - start;
    const double share = std::clamp((p - start).dot(along) / along.squaredNorm(), 0.0, 1.0);
    EXPECT_NEAR((p - start - share * along).norm(), 0.2, 1e-12);
    EXPECT_NEAR(capsule.normals[i].norm(), 1.0, 1e-12);
  }
  const BodyMesh sphere = body_mesh(made(point(start, 0.2)));
  EXPECT_TRUE(is_closed(sphere));
  EXPECT_NEAR(volume(sphere), 4.0 / 3.0 * std::numbers::pi * 0.008, 0.02 * 0.0335);
}

TEST(BodyMesh, OfCoarserStepsHasFewerTrianglesAndLiesOnTheBodyAsWell) {
  const Vec3 centre(0.1, 0.2, 0.3);
  const auto sphere = [&](double arc_step) {
    return body_mesh(made(point(centre, 0.2)), 0.0, 20.0, arc_step);
  };
  const BodyMesh fine = sphere(kArcStep), coarse = sphere(3.0 * kArcStep);
  EXPECT_TRUE(is_closed(coarse));
  EXPECT_LT(8 * coarse.triangles.size(), fine.triangles.size() * 2);
  for (const Vec3& p : coarse.positions) EXPECT_NEAR((p - centre).norm(), 0.2, 1e-12);
}

// The chords cut off less than one per cent.
TEST(BodyMesh, OfCurvedBodiesIsClosedAndOfTheirVolume) {
  constexpr double kPi = std::numbers::pi;
  const std::pair<ShapeResult, double> cases[] = {
      {ellipsoid(Vec3(1, 2, 0.5)), 4.0 / 3.0 * kPi},
      {cylinder(0.5, 1.0), 0.5 * kPi},
      {cone(0.6, 0.5), 0.12 * kPi},
      {truncated_cone(0.4, 0.2, 0.5), kPi / 3.0 * (0.16 + 0.08 + 0.04)},
      {cylinder(0.3, 0.5, 0.2), kPi * 0.09 + kPi * 0.2 * (2.0 * 0.09 + 2.0 * 0.3) + kPi * 0.04 +
                                    kPi * kPi * 0.3 * 0.04 + 4.0 / 3.0 * kPi * 0.008}};
  for (const auto& [shape, expected] : cases) {
    EXPECT_TRUE(is_closed(body_mesh(made(shape))));
    EXPECT_NEAR(volume(body_mesh(made(shape))), expected, 0.02 * expected);
    EXPECT_LE(volume(body_mesh(made(shape))), expected);
  }
}

TEST(BodyMesh, OfAnUnboundedBodyIsCutOff) {
  const HalfSpace wedge[] = {{Vec3(1, 0, 0), 0.0}, {Vec3(0, 1, 0), 0.0}};
  const BodyMesh mesh = body_mesh(made(polyhedron_from_halfspaces(wedge)), 0.0, 2.0);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume(mesh), 16.0, 1e-9);
  const HalfSpace floor[] = {{Vec3(0, 0, 1), 0.0}};
  EXPECT_TRUE(made(polyhedron_from_halfspaces(floor)).is_half_space());
  EXPECT_FALSE(made(polyhedron_from_halfspaces(wedge)).is_half_space());
}

}  // namespace
}  // namespace clearance
