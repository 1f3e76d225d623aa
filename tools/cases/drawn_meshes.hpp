// Meshes of known shape, for tests and the benchmark of convex parts. Lengths are in metres.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"

namespace clearance::drawn {

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

// An open box of five solid walls that touch: two long walls, two short ones between them, and a
// floor below. Lengths are outer ones.
inline TriangleMesh crate_of_solids(const Vec3& size = {0.6, 0.4, 0.3}, double wall = 0.01) {
  TriangleMesh mesh;
  add_box({0.0, 0.0, 0.0}, {size.x(), size.y(), wall}, mesh);
  add_box({0.0, 0.0, wall}, {size.x(), wall, size.z()}, mesh);
  add_box({0.0, size.y() - wall, wall}, size, mesh);
  add_box({0.0, wall, wall}, {wall, size.y() - wall, size.z()}, mesh);
  add_box({size.x() - wall, wall, wall}, {size.x(), size.y() - wall, size.z()}, mesh);
  return mesh;
}

// The same with walls that cross at corners and reach the floor's underside.
inline TriangleMesh crate_of_overlapping_solids(const Vec3& size = {0.6, 0.4, 0.3},
                                                double wall = 0.01) {
  TriangleMesh mesh;
  add_box({0.0, 0.0, 0.0}, {size.x(), size.y(), wall}, mesh);
  add_box({0.0, 0.0, 0.0}, {size.x(), wall, size.z()}, mesh);
  add_box({0.0, size.y() - wall, 0.0}, size, mesh);
  add_box({0.0, 0.0, 0.0}, {wall, size.y(), size.z()}, mesh);
  add_box({size.x() - wall, 0.0, 0.0}, size, mesh);
  return mesh;
}

// A solid of revolution around z: the outline's points are radius and height, counter-clockwise.
// Points on the axis become fans.
inline TriangleMesh turned(const std::vector<Vec2>& outline, int sides) {
  TriangleMesh mesh;
  const auto at = [&](const Vec2& p, int i) {
    const double a = 2.0 * std::numbers::pi * (i % sides) / sides;
    return Vec3(p.x() * std::cos(a), p.x() * std::sin(a), p.y());
  };
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const Vec2& from = outline[k];
    const Vec2& to = outline[(k + 1) % outline.size()];
    if (from.x() == 0.0 && to.x() == 0.0) continue;
    for (int i = 0; i < sides; ++i) {
      add_quad({at(from, i), at(from, i + 1), at(to, i + 1), at(to, i)}, mesh);
    }
  }
  return mesh;
}

// A rod of 120 mm, bent by 90 degrees around an axis 250 mm away, with two bars across it that
// cross each other. The bars are added behind the rod.
inline TriangleMesh bent_rod_with_bars(const std::array<Vec3, 4>& bars) {
  constexpr int kSteps = 16;
  constexpr double kRadius = 0.06, kBend = 0.25, kLength = 0.4;
  std::vector<Vec2> outline = {{0.0, 0.0}};
  for (int i = 0; i <= kSteps; ++i) outline.emplace_back(kRadius, kLength * i / kSteps);
  outline.emplace_back(0.0, kLength);
  TriangleMesh mesh = turned(outline, 24);
  for (Vec3& v : mesh.vertices) {
    const double angle = v.z() / kBend, ring = kBend - v.x();
    v = {ring * std::cos(angle), v.y(), ring * std::sin(angle)};
  }
  add_box(bars[0], bars[1], mesh);
  add_box(bars[2], bars[3], mesh);
  return mesh;
}

// An open box as one closed manifold.
inline TriangleMesh crate(const Vec3& size = {0.6, 0.4, 0.3}, double wall = 0.01) {
  TriangleMesh mesh;
  const Vec3 low(wall, wall, wall), high(size.x() - wall, size.y() - wall, size.z());
  add_box({0.0, 0.0, 0.0}, size, mesh, false);
  add_box(low, high, mesh, false);
  const auto rim = [&](bool inner, int i) {
    const bool right = i == 1 || i == 2, back = i == 2 || i == 3;
    const double x = right ? size.x() : 0.0, y = back ? size.y() : 0.0;
    if (!inner) return Vec3(x, y, size.z());
    return Vec3(right ? high.x() : low.x(), back ? high.y() : low.y(), size.z());
  };
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    add_quad({rim(false, i), rim(false, next), rim(true, next), rim(true, i)}, mesh);
  }
  return mesh;
}

// A thin-walled cylinder with a bottom, of 80 mm and 100 mm.
inline TriangleMesh cup(double radius = 0.04, double height = 0.1, double wall = 0.003,
                        int sides = 64) {
  const double inner = radius - wall;
  return turned(
      {{0.0, 0.0}, {radius, 0.0}, {radius, height}, {inner, height}, {inner, wall}, {0.0, wall}},
      sides);
}

// An angle bracket with a rib: plates of 8 mm at a right angle, and a triangle between them.
inline TriangleMesh bracket() {
  TriangleMesh mesh;
  add_box({0.0, 0.0, 0.0}, {0.12, 0.08, 0.008}, mesh);
  add_box({0.0, 0.0, 0.0}, {0.008, 0.08, 0.1}, mesh);
  const std::array<Vec2, 3> side = {Vec2(0.008, 0.008), Vec2(0.08, 0.008), Vec2(0.008, 0.08)};
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const double y : {0.036, 0.044}) {
    for (const Vec2& p : side) mesh.vertices.emplace_back(p.x(), y, p.y());
  }
  for (const std::array<std::uint32_t, 3>& t : {std::array<std::uint32_t, 3>{0, 1, 2},
                                                {3, 5, 4},
                                                {0, 3, 4},
                                                {0, 4, 1},
                                                {1, 4, 5},
                                                {1, 5, 2},
                                                {2, 5, 3},
                                                {2, 3, 0}}) {
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
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

}  // namespace clearance::drawn
