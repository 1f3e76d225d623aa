// A shape's convex bodies at a place, without MoveIt.
#pragma once

#include <core/convex_body.hpp>
#include <core/pose.hpp>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace octomap {
class OcTree;
}

namespace clearance_moveit {

using clearance::Pose;
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
  // In the frame of the shape, which their union contains. Empty: see `fault`. For octrees, below.
  std::vector<clearance::ConvexBody> bodies;
  std::vector<Box> boxes;   // one around each body
  double mesh_error = 0.0;  // m: no point of the bodies is farther than this from the mesh
  // An octree is read while it is checked, since its owner may change it at any time. Then `bodies`
  // has a cube at the origin for each depth, from the root down.
  std::shared_ptr<const octomap::OcTree> octree;
  std::string
      fault;  // not empty: nothing stands for the shape, so every check of it is a collision
};

struct PosedPart {
  std::shared_ptr<const ShapeParts> shape;
  // The only body of the part; null: the part is a whole octree, or nothing stands for the shape.
  const clearance::ConvexBody* body = nullptr;
  Pose world_from_part;  // or from the frame of its link, where a function says so
  std::uint32_t owner = 0;

  bool operator==(const PosedPart& other) const {
    return shape == other.shape && body == other.body && owner == other.owner &&
           clearance::same_pose(world_from_part, other.world_from_part);
  }
};

// The box around a body at a pose, rounding included.
[[nodiscard]] Box placed(const Box& box, const Pose& pose) noexcept;

}  // namespace clearance_moveit
