// Distance queries of two posed parts: of their convex bodies, or of the leaves of an octree.
#pragma once

#include "posed_part.hpp"

#include <octomap/octomap.h>
#include <algorithm>
#include <array>
#include <core/distance.hpp>

namespace clearance_moveit {

// Points and normal are in the world.
struct Found {
  bool collides = false;       // not certified disjoint
  double distance = 0.0;       // m: a certified lower bound; if they collide, at most 0
  Vec3 normal = Vec3::Zero();  // unit, from A towards B
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();
};

enum class Depth : bool { kNotAsked, kAsked };

[[nodiscard]] Found query(const clearance::ConvexBody& a, const Pose& world_from_a,
                          const clearance::ConvexBody& b, const Pose& world_from_b, Depth depth);

// Calls visit(body, pose) for every occupied leaf of the octree of a part that may be within
// `within`, m, of a box in the world. The visitor may lower `within`. Nearer cubes come first.
// Returns false as soon as the visitor does.
template <class Visit>
bool visit_leaves(const PosedPart& octree, const Box& near, const double& within,
                  const Visit& visit);

// Calls visit(found) for each pair of bodies of two parts, but for leaves of octrees that are
// farther than `within`, m. If nothing stands for one of the parts, the only answer is a collision.
// The visitor returns false to end.
template <class Visit>
bool query_parts(const PosedPart& a, const Box& box_a, const PosedPart& b, const Box& box_b,
                 const double& within, Depth depth, const Visit& visit);

// A node of an octree with its cube in the frame of the tree.
struct Cube {
  const octomap::OcTreeNode* node;
  Vec3 centre;
  double half;  // of the side, m
  unsigned depth;
  double gap;  // to the box, m
};

// The children of a node, the nearest to the box first. Returns how many there are.
unsigned sorted_children(const octomap::OcTree& tree, const Cube& parent, const Box& near,
                         std::array<Cube, 8>& children);
// The root; without a node if the tree is empty.
[[nodiscard]] Cube root_of(const octomap::OcTree& tree);
// A box in the frame of the part that contains one in the world.
[[nodiscard]] Box box_in_part(const Pose& world_from_part, const Box& box);

template <class Visit>
bool visit_below(const PosedPart& octree, const Cube& cube, const Box& near, const double& within,
                 const Visit& visit) {
  const octomap::OcTree& tree = *octree.shape->octree;
  if (!tree.nodeHasChildren(cube.node)) {
    if (!tree.isNodeOccupied(cube.node)) return true;
    Pose pose = octree.world_from_part;
    pose.position = clearance::transform(octree.world_from_part, cube.centre);
    return visit(octree.shape->bodies[cube.depth], pose);
  }
  std::array<Cube, 8> children;
  const unsigned count = sorted_children(tree, cube, near, children);
  for (unsigned i = 0; i < count && children[i].gap <= within; ++i)
    if (!visit_below(octree, children[i], near, within, visit)) return false;
  return true;
}

template <class Visit>
bool visit_leaves(const PosedPart& octree, const Box& near, const double& within,
                  const Visit& visit) {
  const Cube root = root_of(*octree.shape->octree);
  if (root.node == nullptr) return true;
  return visit_below(octree, root, box_in_part(octree.world_from_part, near), within, visit);
}

template <class Visit>
bool query_parts(const PosedPart& a, const Box& box_a, const PosedPart& b, const Box& box_b,
                 const double& within, Depth depth, const Visit& visit) {
  for (const PosedPart* part : {&a, &b}) {
    if (part->shape->fault.empty()) continue;
    const Vec3& at = part->world_from_part.position;
    return visit(Found{true, 0.0, Vec3::UnitZ(), at, at});
  }
  const auto with = [&](const clearance::ConvexBody& body_a, const Pose& pose_a, const Box& box) {
    const auto ask = [&](const clearance::ConvexBody& body_b, const Pose& pose_b) {
      return visit(query(body_a, pose_a, body_b, pose_b, depth));
    };
    return b.body != nullptr ? ask(*b.body, b.world_from_part) : visit_leaves(b, box, within, ask);
  };
  if (a.body != nullptr) return with(*a.body, a.world_from_part, box_a);
  return visit_leaves(a, box_b, within, [&](const clearance::ConvexBody& cube, const Pose& pose) {
    return with(cube, pose, placed(a.shape->boxes[&cube - a.shape->bodies.data()], pose));
  });
}

}  // namespace clearance_moveit
