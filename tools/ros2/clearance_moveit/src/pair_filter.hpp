// Decides if a pair of owners is checked: by the allowed collision matrix, the group of a request
// and the links that attached bodies may touch.
#pragma once

#include "posed_parts.hpp"

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include <moveit/collision_detection/collision_matrix.hpp>
#include <moveit/robot_model/robot_model.hpp>

namespace clearance_moveit {

class PairFilter {
 public:
  // Both may be null: no matrix, or all links.
  PairFilter(const collision_detection::AllowedCollisionMatrix* matrix,
             const std::set<const moveit::core::LinkModel*>* active, const PosedParts& a,
             const PosedParts& b);
  // The links that a group moves; null: it is no group of the robot.
  static const std::set<const moveit::core::LinkModel*>* links_of(
      const moveit::core::RobotModel& model, const std::string& group);

  enum class Decision : std::uint8_t {
    kOpen,
    kLeftOut,
    kChecked,
    kConditional,  // checked, and a function decides on each contact
  };
  // Looks a pair up only once: the matrix takes most of the time of a far pair.
  [[nodiscard]] Decision decide(std::uint32_t owner_a, std::uint32_t owner_b);
  // The function of a conditional pair.
  [[nodiscard]] collision_detection::DecideContactFn decider(std::uint32_t owner_a,
                                                             std::uint32_t owner_b) const;

 private:
  [[nodiscard]] Decision look_up(const Owner& a, const Owner& b) const;

  const collision_detection::AllowedCollisionMatrix* matrix_;
  const std::set<const moveit::core::LinkModel*>* active_;
  const PosedParts& a_;
  const PosedParts& b_;
  std::vector<Decision> decisions_;  // of each owner of A with each of B
};

}  // namespace clearance_moveit
