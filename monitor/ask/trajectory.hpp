// Joint trajectories over time: positions, and bounds of what happens in an interval of time.
//
// The motion in question and those beside it, which have times of their own, share one timeline. A
// new segment of it begins wherever one of them, or an object's motion, has a waypoint.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/bodies/tracked_variable.hpp"
#include "monitor/interface/question.hpp"

namespace clearance {

// Some whole segments, or a part of one. Segment i is between the times i and i + 1.
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

// Velocities of a joint, per second.
struct VelocityRange {
  double least = 0.0, most = 0.0;

  [[nodiscard]] double largest_speed() const noexcept { return std::max(-least, most); }
};

// A step between two waypoints is 0, or at least this, s. All figures of a motion, up to the square
// of a jerk, are finite then.
inline constexpr double kShortestStep = 1e-20;

// The row of a track's waypoints that begins in or before a segment of the timeline.
inline constexpr std::int32_t kBeforeFirstRow = -1;

// Writes, for each segment of the timeline, the last of `own` times that is not after its begin.
void find_rows(std::span<const double> timeline, std::span<const double> own,
               std::vector<std::int32_t>& rows);

class Trajectory {
 public:
  // Allocates for `variables` variables of a scene.
  explicit Trajectory(std::size_t variables);

  // Takes the trajectories of a question, or returns what is wrong with them. The question must
  // stay until the next call. Allocates only for more waypoints than in any question before.
  [[nodiscard]] std::optional<std::string> take(const Question& question, const Scene& scene);

  // Lets the joints of the motion in question go on past its last waypoint for a time, s, with
  // these velocities, one for each joint. That is a further segment. The velocities must stay.
  void go_on(double time, std::span<const double> velocities);
  // The segments of the motion itself.
  [[nodiscard]] std::uint32_t planned_segments() const noexcept {
    return segments() - (tracks_.front().onward.empty() ? 0 : 1);
  }
  // In a stretch of one segment, the velocities of a joint of the motion in question.
  [[nodiscard]] VelocityRange velocities(std::size_t joint, const Stretch& stretch) const noexcept;
  // As they are at its last waypoint.
  [[nodiscard]] double last_velocity(std::size_t joint) const noexcept;

  [[nodiscard]] std::span<const double> times() const noexcept { return times_; }
  [[nodiscard]] Stretch whole() const noexcept;
  [[nodiscard]] double begin() const noexcept { return times_.front(); }
  [[nodiscard]] double end() const noexcept { return times_.back(); }
  // The number of segments: at least one.
  [[nodiscard]] std::uint32_t segments() const noexcept {
    return static_cast<std::uint32_t>(times_.size() < 2 ? 1 : times_.size() - 1);
  }
  [[nodiscard]] Stretch segment(std::uint32_t i) const noexcept {
    return {i, i, times_[i], times_.size() < 2 ? times_[i] : times_[i + 1]};
  }
  // Tells whether a variable has a position for which `is_outside` is true. `held` is its position
  // if it has no waypoints. With `between` a cubic counts with its control points, between which it
  // stays; without it waypoints count alone.
  template <class IsOutside>
  [[nodiscard]] bool leaves(std::uint32_t variable, const IsOutside& is_outside, double held,
                            bool between) const {
    for (const Track& track : tracks_) {
      for (std::size_t joint = 0; joint < track.joints; ++joint) {
        if (moved_[track.first_joint + joint] != variable) continue;
        for (std::size_t row = 0; row < track.motion->times.size(); ++row) {
          if (is_outside(track.position(row, joint))) return true;
          if (between && std::ranges::any_of(controls_beside(track, row, joint), is_outside))
            return true;
        }
        return false;
      }
    }
    return is_outside(held);
  }
  // Calls use(variable, most) for each joint that may be off its waypoints.
  template <class Use>
  void for_each_deviation(const Use& use) const {
    for (const Track& track : tracks_) {
      for (std::size_t joint = 0; joint < track.motion->deviations.size(); ++joint)
        use(moved_[track.first_joint + joint], track.motion->deviations[joint]);
    }
  }
  // Indices into Scene::variables of the joints that have waypoints.
  [[nodiscard]] std::span<const std::uint32_t> moved() const noexcept { return moved_; }
  // No computed position is farther from the exact one, rad or m. It includes what the rounding of
  // speeds adds to a position within a stretch.
  [[nodiscard]] double position_rounding() const noexcept { return position_rounding_; }

  // Returns the instant at which a stretch is examined and divided: a waypoint, or the middle.
  [[nodiscard]] double middle(const Stretch& stretch) const noexcept;
  // The two parts of a stretch before and after its middle.
  [[nodiscard]] static Stretch before(const Stretch& stretch, double middle) noexcept;
  [[nodiscard]] static Stretch after(const Stretch& stretch, double middle) noexcept;
  // The segment of the timeline that places bodies at the middle of a stretch.
  [[nodiscard]] static std::uint32_t segment_at_middle(const Stretch& stretch) noexcept {
    return stretch.is_in_one_segment() ? stretch.first : (stretch.first + stretch.last + 1) / 2;
  }

  // Sets positions and velocities at an instant of the segment, and the bounds in the stretch
  // around it. Entries of other variables stay as they are.
  void place(const Stretch& stretch, double at, std::span<TrackedVariable> variables,
             std::span<VariableBounds> bounds) const noexcept;

 private:
  struct Track {
    const JointTrajectory* motion = nullptr;
    std::uint32_t first_joint = 0, joints = 0;  // into moved_
    std::uint32_t rows_of = 0;                  // into rows_
    // By joint, per second: past the last waypoint it goes on to a further row. Empty: it rests.
    std::span<const double> onward = {};
    double onward_time = 0.0;  // s
    [[nodiscard]] std::int32_t last_row() const noexcept {
      return static_cast<std::int32_t>(motion->times.size()) - 1;
    }
    [[nodiscard]] std::size_t rows() const noexcept {
      return motion->times.size() + (onward.empty() ? 0 : 1);
    }
    [[nodiscard]] double time(std::size_t row) const noexcept {
      return row < motion->times.size() ? motion->times[row] : motion->times.back() + onward_time;
    }
    [[nodiscard]] bool is_cubic() const noexcept {
      return !motion->velocities.empty() && motion->times.size() > 1;
    }
    [[nodiscard]] double position(std::size_t row, std::size_t joint) const noexcept {
      if (row == motion->times.size())
        return position(row - 1, joint) + onward_time * onward[joint];
      return motion->positions[row * joints + joint];
    }
    [[nodiscard]] double velocity(std::size_t row, std::size_t joint) const noexcept {
      return motion->velocities[row * joints + joint];
    }
  };
  struct State {
    double position, speed, acceleration, jerk;
  };
  [[nodiscard]] std::optional<std::string> add_track(const JointTrajectory& motion,
                                                     const Scene& scene);
  void make_timeline(const Question& question);
  [[nodiscard]] static State state(const Track& track, std::int32_t row, std::size_t joint,
                                   double at) noexcept;
  // From a row to the next one, s.
  [[nodiscard]] static double length_of(const Track& track, std::int32_t row) noexcept {
    const auto r = static_cast<std::size_t>(row);
    return track.time(r + 1) - track.time(r);
  }
  [[nodiscard]] static double largest_acceleration(const Track& track, std::int32_t row,
                                                   std::size_t joint) noexcept;
  // The largest distance of a cubic beside a waypoint from its chord; linear: 0.
  [[nodiscard]] static double bulge(const Track& track, std::int32_t row,
                                    std::size_t joint) noexcept;
  // The position of a waypoint, and the control points before and after it.
  [[nodiscard]] static std::array<double, 3> controls_beside(const Track& track, std::size_t row,
                                                             std::size_t joint) noexcept;
  void place_in_segment(const Track& track, const Stretch& stretch, double at,
                        std::span<TrackedVariable> variables,
                        std::span<VariableBounds> bounds) const noexcept;
  void place_at_waypoint(const Track& track, const Stretch& stretch, double at,
                         std::span<TrackedVariable> variables,
                         std::span<VariableBounds> bounds) const noexcept;

  std::vector<Track> tracks_;
  std::vector<std::uint32_t> moved_;             // track by track
  std::vector<double> times_;                    // of the timeline: all different, rising
  std::vector<std::vector<std::int32_t>> rows_;  // by track, by segment
  // The largest magnitude of a position, or of a velocity times the length of the motion.
  double largest_position_ = 0.0;
  double position_rounding_ = 0.0;
};

// Returns the index of a variable by its name; nothing if there is none.
[[nodiscard]] std::optional<std::uint32_t> variable_named(const Scene& scene,
                                                          const std::string& name) noexcept;

}  // namespace clearance
