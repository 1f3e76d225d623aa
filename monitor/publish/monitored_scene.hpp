// The present scene as MoveIt has it: moveit_msgs/PlanningScene.
#pragma once

#include "config/cell/cell.hpp"
#include "config/moveit/message.hpp"
#include "monitor/intake/from_wire.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// More bodies have no collision matrix in the message: it is square.
inline constexpr std::size_t kMostInMatrix = 1024;

// Returns the whole scene, no diff: fixed objects in the cell's world, and what links carry.
// Shapes are spheres, planes and meshes of the parts. Chords of rounded surfaces are inside of them
// by at most 0.4 % of the radius. The matrix allows every pair that the cell does not watch. The
// padding of a link is its margin; scales are not stated. Left out are absent objects, objects
// whose poses arrive, and what such an object carries.
[[nodiscard]] moveit::PlanningScene monitored_scene(const Cell& cell);

[[nodiscard]] Sample<moveit_msgs_msg_dds__PlanningScene_> to_wire(
    const moveit::PlanningScene& scene);

}  // namespace clearance
