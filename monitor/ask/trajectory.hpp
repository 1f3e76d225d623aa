// A joint trajectory over time: positions, and bounds of what happens in an interval of time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/ask/question.hpp"
#include "monitor/kinematics/tracked_variable.hpp"

namespace clearance {

// Some whole segments, or a part of one. Segment i is between waypoints i and i + 1.
struct Stretch {
  std::uint32_t first = 0, last = 0;  // segments, both included
  double from = 0.0, to = 0.0;        // s

  [[nodiscard]] bool is_in_one_segment() const noexcept { return first == last; }
};

// The bounds of one variable in a stretch with a chosen instant in it.
struct VariableBounds {
  double deviation = 0.0;     // from the position at the instant, at most; rad or m
  double speed = 0.0;         // at most, per second; only in one segment
  double acceleration = 0.0;  // at most, per second squared; only in one segment
};

class Trajectory {
 public:
  // Allocates for `variables` variables of a scene.
  explicit Trajectory(std::size_t variables);

  // Takes a trajectory, or returns what is wrong with it. `motion` must stay until the next call.
  [[nodiscard]] std::optional<std::string> take(const JointTrajectory& motion, const Scene& scene);

  [[nodiscard]] Stretch whole() const noexcept;
  [[nodiscard]] double begin() const noexcept { return motion_->times.front(); }
  [[nodiscard]] double end() const noexcept { return motion_->times.back(); }
  // Tells whether a variable has a position for which `is_outside` is true. `held` is its position
  // if it has no waypoints. A cubic counts with its control points, between which it stays.
  template <class IsOutside>
  [[nodiscard]] bool leaves(std::uint32_t variable, const IsOutside& is_outside,
                            double held) const {
    for (std::size_t joint = 0; joint < moved_.size(); ++joint) {
      if (moved_[joint] != variable) continue;
      for (std::size_t row = 0; row < motion_->times.size(); ++row) {
        for (const double control : controls_beside(row, joint)) {
          if (is_outside(control)) return true;
        }
      }
      return false;
    }
    return is_outside(held);
  }
  // Indices into Scene::variables of the joints that have waypoints.
  [[nodiscard]] std::span<const std::uint32_t> moved() const noexcept { return moved_; }

  // Returns the instant at which a stretch is examined and divided: a waypoint, or the middle.
  [[nodiscard]] static double middle(const Stretch& stretch,
                                     std::span<const double> times) noexcept;
  [[nodiscard]] double middle(const Stretch& stretch) const noexcept {
    return middle(stretch, motion_->times);
  }
  // The two parts of a stretch before and after its middle.
  [[nodiscard]] Stretch before(const Stretch& stretch, double middle) const noexcept;
  [[nodiscard]] Stretch after(const Stretch& stretch, double middle) const noexcept;

  // Sets positions and velocities at an instant of the segment, and the bounds in the stretch
  // around it. Entries of other variables stay as they are.
  void place(const Stretch& stretch, double at, std::span<TrackedVariable> variables,
             std::span<VariableBounds> bounds) const noexcept;

 private:
  struct State {
    double position, speed, acceleration;
  };
  [[nodiscard]] double position(std::size_t row, std::size_t joint) const noexcept {
    return motion_->positions[row * moved_.size() + joint];
  }
  [[nodiscard]] double velocity(std::size_t row, std::size_t joint) const noexcept {
    return motion_->velocities[row * moved_.size() + joint];
  }
  [[nodiscard]] State state(std::size_t segment, std::size_t joint, double at) const noexcept;
  [[nodiscard]] double largest_acceleration(std::size_t segment, std::size_t joint) const noexcept;
  // The largest distance of a cubic beside a waypoint from its chord; linear: 0.
  [[nodiscard]] double bulge(std::size_t segment, std::size_t joint) const noexcept;
  // The position of a waypoint, and the control points before and after it.
  [[nodiscard]] std::array<double, 3> controls_beside(std::size_t row,
                                                      std::size_t joint) const noexcept;
  [[nodiscard]] std::optional<std::string> fault(const JointTrajectory& motion) const;

  const JointTrajectory* motion_ = nullptr;
  std::vector<std::uint32_t> moved_;
};

// Returns the index of a variable by its name; nothing if there is none.
[[nodiscard]] std::optional<std::uint32_t> variable_named(const Scene& scene,
                                                          const std::string& name) noexcept;

}  // namespace clearance
