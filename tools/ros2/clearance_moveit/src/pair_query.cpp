#include "pair_query.hpp"

#include <algorithm>
#include <cstddef>

namespace clearance_moveit {
namespace {

// Hints of earlier queries of this thread. Any state is accepted: a wrong one only costs time.
clearance::TrackingState& hint(const void* a, const void* b) {
  static thread_local std::array<clearance::TrackingState, 1024> states;
  const auto mixed = (reinterpret_cast<std::uintptr_t>(a) * 0x9E3779B97F4A7C15U) ^
                     (reinterpret_cast<std::uintptr_t>(b) * 0xC2B2AE3D27D4EB4FU);
  return states[mixed >> 54U];
}

}  // namespace

Found query(const clearance::ConvexBody& a, const Pose& world_from_a,
            const clearance::ConvexBody& b, const Pose& world_from_b, Depth depth) {
  const clearance::DistanceResult r =
      clearance::distance(a, b, clearance::relative_pose(world_from_a, world_from_b), hint(&a, &b),
                          {.depth = depth == Depth::kAsked});
  Found found;
  found.collides = !(r.lower > 0.0);
  found.distance = !found.collides          ? r.lower
                   : depth == Depth::kAsked ? std::min(r.distance, 0.0)
                                            : 0.0;
  const clearance::Mat3 rotation = clearance::rotation_matrix(world_from_a.orientation);
  found.normal = rotation * r.normal;
  found.point_a = rotation * r.point_on_a + world_from_a.position;
  found.point_b = rotation * r.point_on_b + world_from_a.position;
  return found;
}

Cube root_of(const octomap::OcTree& tree) {
  return {tree.getRoot(), Vec3::Zero(), 0.5 * tree.getNodeSize(0), 0, 0.0};
}

unsigned sorted_children(const octomap::OcTree& tree, const Cube& parent, const Box& near,
                         std::array<Cube, 8>& children) {
  unsigned count = 0;
  const double half = 0.5 * parent.half;
  for (unsigned i = 0; i < 8; ++i) {
    if (!tree.nodeChildExists(parent.node, i)) continue;
    const Vec3 centre =
        parent.centre + half * Vec3((i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                                    (i & 4U) != 0 ? 1.0 : -1.0);
    const Box cube{centre.array() - half, centre.array() + half};
    children[count++] = {tree.getNodeChild(parent.node, i), centre, half, parent.depth + 1,
                         gap(cube, near)};
  }
  std::sort(children.begin(), children.begin() + count,
            [](const Cube& a, const Cube& b) { return a.gap < b.gap; });
  return count;
}

Box seen_from(const Pose& world_from_part, const Box& box) {
  Pose part_from_world;
  part_from_world.orientation = world_from_part.orientation.conjugate();
  part_from_world.position = -(part_from_world.orientation * world_from_part.position);
  return placed(box, part_from_world);
}

}  // namespace clearance_moveit
