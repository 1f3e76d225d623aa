// What all ticks so far have been told of the joints of robots, and where their links are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/kinematics/forward_kinematics.hpp"
#include "monitor/kinematics/tracked_variable.hpp"
#include "monitor/objects/tracked_object.hpp"

namespace clearance {

// Poses and joint states may both be sent of a robot's links. As soon as the first position of one
// of its joints is taken, its links are where its joints say, and poses of theirs are refused.
class RobotInputs {
 public:
  explicit RobotInputs(const Scene& scene);

  // As Scene::variables.
  [[nodiscard]] std::span<TrackedVariable> variables() noexcept { return variables_; }
  [[nodiscard]] std::span<const TrackedVariable> variables() const noexcept { return variables_; }

  // As of the last place(): as Robot::links. Of a robot that was not heard nothing is known.
  [[nodiscard]] std::span<const LinkState> links(std::uint32_t robot) const noexcept {
    return kinematics_.links(robot);
  }

  // The first object that is a link; the number of objects when none is.
  [[nodiscard]] std::uint32_t first_link() const noexcept { return first_link_; }

  // A position of this variable was taken.
  void hear(std::uint32_t variable) noexcept { heard_[scene_.variables[variable].robot] = true; }

  // Whether the object is a link that follows joints.
  [[nodiscard]] bool follows_joints(std::uint32_t object) const noexcept {
    return object >= first_link_ && heard_[robot_of_[object - first_link_]];
  }

  void forget_ages(std::int64_t now_ns) noexcept;

  // Ends the tick's input: places the links of robots that were heard. The objects that robots
  // stand on have been advanced.
  void place(std::int64_t now_ns, std::span<TrackedObject> objects) noexcept;

 private:
  const Scene& scene_;
  std::uint32_t first_link_;
  std::vector<std::uint32_t> robot_of_;  // of each object from first_link_ on
  std::vector<bool> heard_;              // by robot
  std::vector<TrackedVariable> variables_;
  std::vector<LinkState> bases_;  // by robot
  ForwardKinematics kinematics_;
};

}  // namespace clearance
