// Checks a whole motion of the robot against the world, by the certified search of monitor/ask.
#pragma once

#include "pair_filter.hpp"
#include "posed_parts.hpp"

#include <optional>
#include <string>
#include <variant>

#include <moveit/robot_state/robot_state.hpp>

namespace clearance_moveit {

struct MotionVerdict {
  bool is_free = false;     // certainly disjoint at all instants
  double contact_at = 0.0;  // unless free: a share of the motion at which they collide, or may
  double distance = 0.0;    // m: a lower bound over all instants, if it was asked for
};

struct MotionRequest {
  bool distance = false;
  bool instant = false;  // the first contact is asked for, and not only a verdict
};

// Every joint moves linearly from one state to the other, a continuous joint along the shorter arc.
// `robot` has the parts at `from`; `links` has the same parts in the frames of their links. Pairs
// that a function decides on count as checked. Returns why there is no verdict: a sentence.
[[nodiscard]] std::variant<MotionVerdict, std::string> check_motion(
    const moveit::core::RobotState& from, const moveit::core::RobotState& to,
    const PosedParts& robot, const PosedParts& links, const PosedParts& world, PairFilter& filter,
    const MotionRequest& request);

// The state at a share of that motion.
[[nodiscard]] moveit::core::RobotState state_at(const moveit::core::RobotState& from,
                                                const moveit::core::RobotState& to, double share);

}  // namespace clearance_moveit
