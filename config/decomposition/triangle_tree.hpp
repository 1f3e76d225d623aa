// Finds the triangle of a mesh that is nearest to a point: a tree of boxes.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "config/decomposition/triangle_mesh.hpp"
#include "core/shapes.hpp"

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

  // Calls `visit` with the number of each triangle that may have a point in the box within `slack`
  // of the plane.
  template <class Visit>
  void visit_near(const HalfSpace& plane, double slack, const Eigen::AlignedBox3d& box,
                  const Visit& visit) const {
    visit_near(0, plane, slack, box, visit);
  }

  [[nodiscard]] const Triangle& triangle(std::size_t i) const { return triangles_[i]; }

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t first = 0, count = 0;  // a leaf: its triangles; else count 0 and the first child
  };
  template <class Visit>
  void visit_near(std::size_t at, const HalfSpace& plane, double slack,
                  const Eigen::AlignedBox3d& box, const Visit& visit) const {
    const Node& node = nodes_[at];
    const double height = plane.normal.dot(node.box.center()) - plane.offset;
    const double extent = 0.5 * plane.normal.cwiseAbs().dot(node.box.sizes());
    if (std::abs(height) > extent + slack || !node.box.intersects(box)) return;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(i);
    if (node.count > 0) return;
    visit_near(node.first, plane, slack, box, visit);
    visit_near(node.first + 1, plane, slack, box, visit);
  }
  void build(std::size_t node, std::uint32_t first, std::uint32_t last);

  std::vector<Triangle> triangles_;  // in the order of the leaves
  std::vector<Node> nodes_;          // two children stand side by side
};

}  // namespace clearance
