// The joints of a robot that is told to stop: where they may be until they stand. STOPS.md has the
// region with its proof.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/ingest.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

class StoppingJoints {
 public:
  // A motion of a question lasts this long, s, whatever the stop takes: others are counted as if
  // all of its time had passed at each of its places.
  static constexpr double kDuration = 1e-6;

  // The robot states how it stops. The scene must outlive this. `motion` gets its names and sizes.
  StoppingJoints(const Scene& scene, std::uint32_t robot, JointTrajectory& motion);

  [[nodiscard]] bool has(std::uint32_t variable) const noexcept {
    return find(variable) != nullptr;
  }

  // Reads positions, velocities and ages of this tick.
  void read(const Inputs& inputs) noexcept;
  // After read(): all joints are on time, with a velocity or a limit of it.
  [[nodiscard]] bool is_usable() const noexcept { return is_usable_; }
  // The limit of a velocity stands for one that is not known.
  [[nodiscard]] bool is_assumed() const noexcept { return is_assumed_; }
  // From this tick until the robot stands, s.
  [[nodiscard]] double time() const noexcept;
  // A joint is no farther from its present position until then, rad or m.
  [[nodiscard]] double covered(std::uint32_t variable) const noexcept;
  // The largest of covered(), rad or m.
  [[nodiscard]] double farthest() const noexcept;
  // Where a joint stands then, if it keeps its velocity until the brakes act and needs all that its
  // stop admits, rad or m: the end of the line, or the far corner of the box.
  [[nodiscard]] double standstill(std::uint32_t variable) const noexcept;
  // States the region of a joint until then: no farther than `most` from `position`, rad or m,
  // however long another stop takes.
  void state(StatedJoint& out, std::uint32_t variable) const noexcept;
  // Writes the motion of a stop from `scaling` times the present speeds.
  void write_motion(double scaling, JointTrajectory& motion) const noexcept;
  // Stops from lower speeds end on a part of the same line.
  [[nodiscard]] bool is_on_line() const noexcept { return stops_.keeps_path && !may_turn_; }
  // With is_on_line(): the largest scaling whose stop ends within this share of the line.
  [[nodiscard]] double scaling_within(double share) const noexcept;

 private:
  static constexpr std::size_t kRows = 2;  // waypoints of a motion
  struct Joint {
    std::uint32_t variable = 0;
    const JointVariable* of = nullptr;
    std::size_t index = 0;                         // into Robot::joints
    const JointStop* stop = nullptr;               // of the step that counts
    double acceleration = kInfinity;               // rad/s2 or m/s2
    double lower = -kInfinity, upper = kInfinity;  // that a sliding joint does not leave, m
    double full_speed = kInfinity;
    // In this tick: the position in use, and the velocity that counts.
    double position = 0.0, velocity = 0.0, speed = 0.0;
    bool may_curve = false;  // its acceleration is stated: it may leave the line
    double gained = 0.0;     // its velocity may change by this until the brakes act
    double age = 0.0;        // s
    bool any_direction = false;

    // Returns by how much the position was beyond the limits.
    double hold_within_limits(double& at) const noexcept;
  };
  [[nodiscard]] const Joint* find(std::uint32_t variable) const noexcept;
  void read(const Inputs& inputs, Joint& joint) noexcept;
  void choose_step(const Inputs& inputs) noexcept;
  [[nodiscard]] double extension(const Inputs& inputs) const noexcept;
  [[nodiscard]] double covered(const Joint& joint) const noexcept;
  [[nodiscard]] double reaction() const noexcept;
  [[nodiscard]] double longest_time(double scaling) const noexcept;
  [[nodiscard]] double in_proportion(double scaling) const noexcept;
  [[nodiscard]] double at_most_in_proportion(double scaling) const noexcept;
  [[nodiscard]] double length_of_line(double scaling) const noexcept;

  const Robot& of_;
  const RobotStops& stops_;
  std::uint32_t robot_;
  double period_;  // s: until the next report
  std::vector<Joint> joints_;
  double age_ = 0.0;  // s: of the oldest position in use
  bool is_usable_ = false, is_assumed_ = false;
  bool is_stopping_ = false;  // all of its brakes act since the oldest position in use
  bool may_turn_ = false;     // the velocity of a joint may be another one when the brakes act
};

}  // namespace clearance
