// A mesh as a set of triangles, without conditions: it may be open, cross itself, have shells
// within shells, and triangles without area.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

using Triangle = std::array<Vec3, 3>;

struct TriangleMesh {
  std::vector<Vec3> vertices;                           // m; finite
  std::vector<std::array<std::uint32_t, 3>> triangles;  // indices of vertices

  [[nodiscard]] Triangle triangle(std::size_t i) const {
    return {vertices[triangles[i][0]], vertices[triangles[i][1]], vertices[triangles[i][2]]};
  }
};

// Covers `triangle` with smaller ones, whose edges are at most `longest`, and calls `take` with
// each. It halves the longest edge repeatedly, so that slivers give few.
template <class Take>
void subdivide(const Triangle& triangle, double longest, const Take& take) {
  std::vector<Triangle> left = {triangle};
  while (!left.empty()) {
    const Triangle t = left.back();
    left.pop_back();
    std::size_t edge = 0;
    double length = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double l = (t[(i + 1) % 3] - t[i]).norm();
      if (l > length) {
        length = l;
        edge = i;
      }
    }
    if (length <= longest) {
      take(t);
      continue;
    }
    const Vec3 middle = 0.5 * (t[edge] + t[(edge + 1) % 3]);
    left.push_back({t[edge], middle, t[(edge + 2) % 3]});
    left.push_back({middle, t[(edge + 1) % 3], t[(edge + 2) % 3]});
  }
}

}  // namespace clearance
