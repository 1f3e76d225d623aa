// Robots that are known not to be there, and which of them a question leaves out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"

namespace clearance {

// Tells it of a robot by its links: one without shapes has no object.
[[nodiscard]] inline bool is_absent(const Robot& robot, std::span<const Object> objects) noexcept {
  return std::ranges::any_of(robot.links, [&](const RobotLink& link) {
    return link.object != RobotLink::kNoObject && objects[link.object].absent;
  });
}

class AbsentRobots {
 public:
  explicit AbsentRobots(const Scene& scene) : left_out_(scene.robots.size(), 0) {
    for (const Robot& robot : scene.robots) absent_.push_back(is_absent(robot, scene.objects));
    any_ = std::ranges::count(absent_, 1) > 0;
  }

  // An absent robot counts all the same if a position of it is stated, or if its carrier is absent
  // and counts.
  template <class HasPosition, class IsPlaced>
  void find_left_out(const Scene& scene, const HasPosition& has_position,
                     const IsPlaced& is_placed) noexcept {
    if (!any_) return;
    left_out_ = absent_;
    for (std::uint32_t v = 0; v < scene.variables.size(); ++v)
      if (has_position(v)) left_out_[scene.variables[v].robot] = 0;
    for (std::uint32_t r = 0; r < left_out_.size(); ++r) {
      const RobotBase& base = scene.robots[r].base;
      const bool carrier_counts = base.kind == RobotBase::Kind::kObject
                                      ? scene.objects[base.object].absent && is_placed(base.object)
                                      : base.kind == RobotBase::Kind::kLink &&
                                            absent_[base.robot] && !left_out_[base.robot];
      if (carrier_counts) left_out_[r] = 0;
    }
  }
  [[nodiscard]] bool any() const noexcept { return any_; }
  [[nodiscard]] bool is_left_out(std::uint32_t robot) const noexcept {
    return left_out_[robot] != 0;
  }

 private:
  std::vector<std::uint8_t> absent_, left_out_;  // by robot
  bool any_ = false;
};

}  // namespace clearance
