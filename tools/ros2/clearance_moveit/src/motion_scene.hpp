// A scene of Clearance with the robot of MoveIt, what it carries and the world around it.
#pragma once

#include "pair_filter.hpp"
#include "posed_parts.hpp"

#include <config/scene/scene.hpp>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <moveit/robot_state/robot_state.hpp>

namespace clearance_moveit {

// By MoveIt's index of links: the frame of the joint at zero in the parent link. Joints of several
// variables rest where they are in this state.
[[nodiscard]] std::vector<Pose> rests_of(const moveit::core::RobotState& state);

// While all joints that slide are at zero, no point of the robot is farther from any axis of its
// joints than this, m. `links` has its parts in the frames of their links.
[[nodiscard]] double reach(const moveit::core::RobotModel& model, std::span<const Pose> rests,
                           const PosedParts& links);

// The world with the leaves of octrees as parts that the robot may meet while none of its points
// moves by more than `within`, m. The owners stay.
[[nodiscard]] PosedParts with_leaves(const PosedParts& world, const PosedParts& robot,
                                     double within);

// The pairs that the filter checks, as objects of motion_scene().
[[nodiscard]] std::vector<clearance::ObjectPair> watched_pairs(const PosedParts& links,
                                                               const PosedParts& world,
                                                               PairFilter& filter);

// The objects are the owners of the world, then those of the robot, in their order. Otherwise
// returns what is wrong as text.
[[nodiscard]] std::variant<clearance::Scene, std::string> motion_scene(
    const moveit::core::RobotModel& model, std::span<const Pose> rests, const PosedParts& links,
    const PosedParts& world, std::vector<clearance::ObjectPair> pairs);

}  // namespace clearance_moveit
