// Finds the triangle of a mesh that is nearest to a point: a tree of boxes.
#pragma once

#include <cstdint>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"

namespace clearance {

// Returns an upper bound of the distance to a triangle, up to rounding. It is the distance to the
// triangle's nearest point, unless the triangle is nearly degenerate.
[[nodiscard]] double distance_to(const Triangle& triangle, const Vec3& point);

class TriangleTree {
 public:
  // The mesh has at least one triangle.
  explicit TriangleTree(const TriangleMesh& mesh);

  struct Nearest {
    std::size_t triangle;  // as of number()
    double distance;
  };
  [[nodiscard]] Nearest nearest(const Vec3& point) const;

  [[nodiscard]] const Triangle& triangle(std::size_t i) const { return triangles_[i]; }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0, count = 0;  // a leaf: its triangles; else count 0 and the first child
  };
  void build(std::size_t node, std::uint32_t first, std::uint32_t last);

  std::vector<Triangle> triangles_;  // in the order of the leaves
  std::vector<Node> nodes_;          // two children stand side by side
};

}  // namespace clearance
