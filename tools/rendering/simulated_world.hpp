// All bodies of a simulation at one time, as its cameras see them.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/cell/cell.hpp"
#include "monitor/bodies/forward_kinematics.hpp"
#include "tools/rendering/depth_renderer.hpp"
#include "tools/rendering/person.hpp"

namespace clearance {

// The frame of tf in which the sensor is mounted. The messages of a sensor without a mount have the
// sensor's name there. Empty: it is in none.
[[nodiscard]] std::string frame_of(const Sensor& sensor);
// True if the simulation has a place for the sensor. It has places for the frames of tf that are
// the world's, links, objects, or movers of the simulation.
[[nodiscard]] bool has_place(const Cell& cell, const Sensor& sensor);

// Returns the positions of all variables of a cell's robots at a time after the start, s.
using JointMotion = std::function<void(double t_s, std::vector<JointSample>& joints)>;

// The fixed objects of the cell, those that its simulation moves, its robots by forward kinematics,
// and people whom the cell does not know. Other moving objects are nowhere.
class SimulatedWorld {
 public:
  static constexpr std::uint32_t kPerson = std::numeric_limits<std::uint32_t>::max() - 1;

  // The cell must outlive this.
  SimulatedWorld(const Cell& cell, JointMotion joints, std::vector<WalkingPerson> people);

  void place(double t_s);

  // Labels are ids of objects, or kPerson. Valid until the next place().
  [[nodiscard]] std::span<const rendering::PlacedBody> bodies() const noexcept { return bodies_; }
  // World from object: of a link, too. Nothing for objects that are nowhere.
  [[nodiscard]] const std::optional<Pose>& object(std::uint32_t id) const noexcept {
    return objects_[id];
  }
  // World from sensor, if what it is mounted on has a place now.
  [[nodiscard]] std::optional<Pose> sensor(const Sensor& sensor) const;
  // True for links, and for what is attached to them.
  [[nodiscard]] bool is_of_robot(std::uint32_t object) const noexcept {
    return object < of_robot_.size() && of_robot_[object];
  }

 private:
  void place_robots(double t_s);
  void add_bodies();
  [[nodiscard]] std::optional<Pose> place_of(const RobotBase& base) const;

  const Cell& cell_;
  JointMotion joints_;
  std::vector<WalkingPerson> people_;
  std::vector<PoseAt> simulated_;
  std::vector<JointSample> samples_;
  std::vector<TrackedVariable> variables_;
  std::vector<LinkState> bases_;  // by robot
  double t_s_ = 0.0;
  ForwardKinematics kinematics_;
  std::vector<std::optional<Pose>> objects_;
  std::vector<bool> of_robot_;
  std::vector<rendering::PlacedBody> bodies_;
};

}  // namespace clearance
