// The joint positions of all robots, from the samples of all ticks so far, and the states of their
// links.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "config/scene/scene_map.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "monitor/bodies/tracked_object.hpp"
#include "monitor/bodies/tracked_variable.hpp"
#include "monitor/inputs/state_bytes.hpp"
#include "monitor/interface/robots_seen.hpp"

namespace clearance {

// A source may send both poses and joint states of a robot's links. Once the first position of one
// of its joints is taken, joints alone place the links, and poses sent for them are refused. A
// robot without joints, as is an attached object, follows what it stands on from the start.
class RobotInputs {
 public:
  explicit RobotInputs(const Scene& scene);

  // Same order as Scene::variables.
  [[nodiscard]] std::span<TrackedVariable> variables() noexcept { return variables_; }
  [[nodiscard]] std::span<const TrackedVariable> variables() const noexcept { return variables_; }

  // The states of the links at the last place(), in the order of Robot::links. Nothing is known of
  // a robot without a joint position.
  [[nodiscard]] std::span<const LinkState> links(std::uint32_t robot) const noexcept {
    return kinematics_.links(robot);
  }

  // The index of the first object that is a link, or the number of objects if there are no links.
  [[nodiscard]] std::uint32_t first_link() const noexcept { return first_link_; }

  // Call this when a position of this variable was taken. Returns true if it is the first position
  // of its robot, which then places its links.
  bool hear(std::uint32_t variable) noexcept {
    auto robot = heard_[scene_.variables[variable].robot];
    const bool is_first = !robot;
    robot = true;
    return is_first;
  }

  // True if the object is a link that joints place, or that follows what its robot stands on.
  [[nodiscard]] bool follows_joints(std::uint32_t object) const noexcept {
    return object >= first_link_ && heard_[robot_of_[object - first_link_]];
  }

  // A picture of this sensor says whether robots are where their joints say; `frames` pictures in a
  // row decide. While one sensor denies it, a robot and what it carries count as contradicted.
  void witness(std::uint32_t sensor, const RobotsSeen& seen, std::uint32_t frames) noexcept;
  // A sensor denies that the robot, or what carries it, is where its joints say.
  [[nodiscard]] bool is_denied(std::uint32_t robot) const noexcept;

  // After place(): a joint between the world, or the object on which the robot stands, and this
  // link has no position, is contradicted, or may be anywhere. The same holds for that object.
  [[nodiscard]] bool is_lost(std::uint32_t robot, std::uint32_t link,
                             std::span<const TrackedObject> objects) const noexcept;

  void forget_ages(std::int64_t now_ns) noexcept;

  // Goes on with the positions of the scene before, where the robots are the same.
  void take_over(const RobotInputs& before, const SceneMap& map) noexcept;
  // The same through bytes, for the same scene.
  void save(StateWriter& out) const;
  void restore(StateReader& in, std::int64_t now_ns) noexcept;

  // Ends the tick's input and places the links of all robots with joint positions. The objects on
  // which robots stand must already be advanced.
  void place(std::int64_t now_ns, std::span<TrackedObject> objects,
             std::int64_t response_left_ns = kAnyAge) noexcept;
  // After place(): of a position, as InputRecord says.
  [[nodiscard]] bool response_is_late() const noexcept { return response_is_late_; }

  // Calls visit(name, table) with each table that nothing changes after construction.
  template <class Visit>
  void each_constant(Visit&& visit) const {
    visit("robots of links", robot_of_);
    kinematics_.each_constant(visit);
  }

 private:
  const Scene& scene_;
  std::uint32_t first_link_;
  std::vector<std::uint32_t> robot_of_;  // by object, from first_link_ on
  std::vector<bool> heard_;              // by robot
  std::vector<TrackedVariable> variables_;
  std::vector<LinkState> bases_;  // by robot
  std::vector<SeenCount> seen_;   // by sensor and robot
  ForwardKinematics kinematics_;
  bool response_is_late_ = false;
};

}  // namespace clearance
