// The convex bodies that stand for a shape of MoveIt in distance queries.
#pragma once

#include <core/convex_body.hpp>
#include <memory>
#include <string>
#include <vector>

#include <geometric_shapes/shapes.h>

namespace clearance_moveit {

using clearance::Vec3;

// A box along the axes of its frame, m.
struct Box {
  Vec3 low = Vec3::Constant(-clearance::kInfinity), high = Vec3::Constant(clearance::kInfinity);
};

// The distance of two boxes of one frame, m; 0 if they overlap.
[[nodiscard]] inline double gap(const Box& a, const Box& b) noexcept {
  return (a.low - b.high).cwiseMax(b.low - a.high).cwiseMax(0.0).norm();
}
[[nodiscard]] inline bool overlap(const Box& a, const Box& b) noexcept {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

struct ShapeParts {
  // In the frame of the shape. Their union is the shape, or contains it if it is a mesh.
  std::vector<clearance::ConvexBody> bodies;
  std::vector<Box> boxes;   // one around each body
  double mesh_error = 0.0;  // m: no point of the bodies is farther than this from the mesh
  // An octree is read while it is checked, since its owner may change it at any time. Then `bodies`
  // has a cube at the origin for each depth, from the root down.
  std::shared_ptr<const octomap::OcTree> octree;
  std::string
      fault;  // not empty: nothing stands for the shape, so every check of it is a collision
};

// Returns the parts of a shape with MoveIt's own scale and padding (Shape::scaleAndPadd). Meshes
// are split once for each process and shape, which may take seconds.
[[nodiscard]] std::shared_ptr<const ShapeParts> parts_of(const shapes::ShapeConstPtr& shape,
                                                         double scale = 1.0, double padding = 0.0);

}  // namespace clearance_moveit
