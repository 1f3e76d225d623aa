// Meshes of known shape, for the tests of their convex parts. Lengths are in metres.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"

namespace clearance::test {

inline void add_quad(std::array<Vec3, 4> corners, TriangleMesh& mesh) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), corners.begin(), corners.end());
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

inline void add_box(const Vec3& low, const Vec3& high, TriangleMesh& mesh, bool lid = true) {
  const auto corner = [&](int x, int y, int z) {
    return Vec3(x != 0 ? high.x() : low.x(), y != 0 ? high.y() : low.y(),
                z != 0 ? high.z() : low.z());
  };
  for (const int s : {0, 1}) {
    add_quad({corner(s, 0, 0), corner(s, 1, 0), corner(s, 1, 1), corner(s, 0, 1)}, mesh);
    add_quad({corner(0, s, 0), corner(1, s, 0), corner(1, s, 1), corner(0, s, 1)}, mesh);
    if (s == 0 || lid) {
      add_quad({corner(0, 0, s), corner(1, 0, s), corner(1, 1, s), corner(0, 1, s)}, mesh);
    }
  }
}

// Two bars of 50 mm that meet at a right angle, 200 mm long. Every other vertex is visible from the
// inner corner.
inline TriangleMesh l_shape() {
  const std::array<Vec2, 6> outline = {Vec2(0.05, 0.05), Vec2(0.05, 0.2), Vec2(0.0, 0.2),
                                       Vec2(0.0, 0.0),   Vec2(0.2, 0.0),  Vec2(0.2, 0.05)};
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 6; ++i) {
    for (const double z : {0.0, 0.06})
      mesh.vertices.emplace_back(outline[i].x(), outline[i].y(), z);
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t next = (i + 1) % 6;
    mesh.triangles.push_back({2 * i, 2 * next, 2 * next + 1});
    mesh.triangles.push_back({2 * i, 2 * next + 1, 2 * i + 1});
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, 2 * i, 2 * next});
    mesh.triangles.push_back({1, 2 * i + 1, 2 * next + 1});
  }
  return mesh;
}

// A torus around z, with 32 by 16 quadrilaterals.
inline TriangleMesh torus() {
  TriangleMesh mesh;
  const auto point = [](int i, int k) {
    const double a = 2.0 * std::numbers::pi * i / 32.0, b = 2.0 * std::numbers::pi * k / 16.0;
    const double ring = 0.08 + 0.025 * std::cos(b);
    return Vec3(ring * std::cos(a), ring * std::sin(a), 0.025 * std::sin(b));
  };
  for (int i = 0; i < 32; ++i) {
    for (int k = 0; k < 16; ++k) {
      add_quad({point(i, k), point(i + 1, k), point(i + 1, k + 1), point(i, k + 1)}, mesh);
    }
  }
  return mesh;
}

// Four walls and a floor, made of sheets without thickness.
inline TriangleMesh open_box() {
  TriangleMesh mesh;
  add_box({0.0, 0.0, 0.0}, {0.12, 0.1, 0.08}, mesh, false);
  return mesh;
}

inline TriangleMesh nested_boxes() {
  TriangleMesh mesh;
  add_box({0.0, 0.0, 0.0}, {0.2, 0.2, 0.2}, mesh);
  add_box({0.08, 0.08, 0.08}, {0.12, 0.12, 0.12}, mesh);
  return mesh;
}

// The L with additional triangles: some degenerate to a point or a line, others are repeated.
inline TriangleMesh degenerate_l() {
  TriangleMesh mesh = l_shape();
  mesh.triangles.insert(mesh.triangles.end(), {{0, 0, 0}, {2, 3, 2}, {0, 2, 4}, {0, 2, 4}});
  return mesh;
}

// A thin rib of 0.2 mm between two blocks. Its triangles are a thousand times as long as wide.
inline TriangleMesh slivers() {
  TriangleMesh mesh;
  add_box({0.0, 0.0, 0.0}, {0.04, 0.04, 0.04}, mesh);
  add_box({0.26, 0.0, 0.0}, {0.3, 0.04, 0.04}, mesh);
  add_box({0.04, 0.02, 0.02}, {0.26, 0.0202, 0.0202}, mesh);
  return mesh;
}

// Returns the text of an OBJ file.
inline std::string obj_of(const TriangleMesh& mesh) {
  std::string text;
  for (const Vec3& v : mesh.vertices) {
    text += "v " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " +
            std::to_string(v.z()) + "\n";
  }
  for (const auto& t : mesh.triangles) {
    text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
            std::to_string(t[2] + 1) + "\n";
  }
  return text;
}

}  // namespace clearance::test
