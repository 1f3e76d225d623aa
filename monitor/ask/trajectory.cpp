#include "monitor/ask/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/inputs/joint_batch.hpp"
#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// A bound of some ten roundings, relative to the numbers that take part.
constexpr double kTrajectoryRounding = 0x1p-48;

bool all_within(const std::vector<double>& numbers, double limit) noexcept {
  return std::all_of(numbers.begin(), numbers.end(),
                     [limit](double x) { return std::abs(x) <= limit; });
}

}  // namespace

std::optional<std::uint32_t> variable_named(const Scene& scene, const std::string& name) noexcept {
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    if (scene.variables[i].name == name) return i;
  }
  return std::nullopt;
}

Trajectory::Trajectory(std::size_t variables) { moved_.reserve(variables); }

std::optional<std::string> Trajectory::fault(const JointTrajectory& motion) const {
  const std::size_t rows = motion.times.size(), joints = motion.joints.size();
  if (rows == 0 || joints == 0) return "the motion has no waypoint or no joint";
  if (motion.positions.size() != rows * joints) {
    return "the motion has " + std::to_string(motion.positions.size()) + " positions; expected " +
           std::to_string(joints) + " for each of " + std::to_string(rows) + " times";
  }
  if (!motion.velocities.empty() && motion.velocities.size() != motion.positions.size()) {
    return "the motion needs as many velocities as positions, or none";
  }
  if (!all_within(motion.times, 1e9)) return "a time is not a finite number of at most 1e9 s";
  for (std::size_t i = 1; i < rows; ++i) {
    if (!(motion.times[i] > motion.times[i - 1])) {
      return "the time of waypoint " + std::to_string(i) + " is not after that of the one before";
    }
  }
  if (!all_within(motion.positions, kLargestJoint) ||
      !all_within(motion.velocities, kLargestJoint)) {
    return "a position or velocity is not finite, or larger than 1e6";
  }
  return std::nullopt;
}

std::optional<std::string> Trajectory::take(const JointTrajectory& motion, const Scene& scene) {
  moved_.clear();
  if (std::optional<std::string> text = fault(motion)) return text;
  for (const std::string& joint : motion.joints) {
    const std::optional<std::uint32_t> variable = variable_named(scene, joint);
    if (!variable) return "the cell has no joint \"" + joint + "\"";
    if (std::find(moved_.begin(), moved_.end(), *variable) != moved_.end()) {
      return "joint \"" + joint + "\" is named twice";
    }
    if (moved_.size() == moved_.capacity()) return "the motion names more joints than the cell has";
    moved_.push_back(*variable);
  }
  motion_ = &motion;
  return std::nullopt;
}

Stretch Trajectory::whole() const noexcept {
  const std::size_t rows = motion_->times.size();
  return {0, static_cast<std::uint32_t>(rows < 2 ? 0 : rows - 2), begin(), end()};
}

double Trajectory::middle(const Stretch& stretch, std::span<const double> times) noexcept {
  if (!stretch.is_in_one_segment()) return times[(stretch.first + stretch.last + 1) / 2];
  return stretch.from + 0.5 * (stretch.to - stretch.from);
}

Stretch Trajectory::before(const Stretch& stretch, double middle) const noexcept {
  if (stretch.is_in_one_segment()) return {stretch.first, stretch.first, stretch.from, middle};
  return {stretch.first, (stretch.first + stretch.last + 1) / 2 - 1, stretch.from, middle};
}

Stretch Trajectory::after(const Stretch& stretch, double middle) const noexcept {
  if (stretch.is_in_one_segment()) return {stretch.first, stretch.first, middle, stretch.to};
  return {(stretch.first + stretch.last + 1) / 2, stretch.last, middle, stretch.to};
}

// The cubic p0 + v0 t + ... of Hermite. Its acceleration is linear in time.
Trajectory::State Trajectory::state(std::size_t segment, std::size_t joint,
                                    double at) const noexcept {
  const double p0 = position(segment, joint);
  if (motion_->times.size() < 2) return {p0, 0.0, 0.0};
  const double begins = motion_->times[segment];
  const double length = motion_->times[segment + 1] - begins;
  const double t = std::clamp(at - begins, 0.0, length), u = t / length;
  const double step = position(segment + 1, joint) - p0, rate = step / length;
  if (motion_->velocities.empty()) return {p0 + u * step, rate, 0.0};
  const double v0 = velocity(segment, joint), v1 = velocity(segment + 1, joint);
  const double a = (6.0 * rate - 4.0 * v0 - 2.0 * v1) / length;  // at the start
  const double jerk = (6.0 * v0 + 6.0 * v1 - 12.0 * rate) / (length * length);
  return {p0 + t * (v0 + t * (0.5 * a + t * (jerk / 6.0))), v0 + t * (a + 0.5 * t * jerk),
          a + t * jerk};
}

double Trajectory::largest_acceleration(std::size_t segment, std::size_t joint) const noexcept {
  return std::max(std::abs(state(segment, joint, motion_->times[segment]).acceleration),
                  std::abs(state(segment, joint, motion_->times[segment + 1]).acceleration));
}

// A function whose second derivative is at most a leaves its chord by at most a length^2 / 8.
double Trajectory::bulge(std::size_t segment, std::size_t joint) const noexcept {
  if (motion_->velocities.empty() || motion_->times.size() < 2) return 0.0;
  const double length = motion_->times[segment + 1] - motion_->times[segment];
  return 0.125 * length * length * largest_acceleration(segment, joint);
}

std::array<double, 3> Trajectory::controls_beside(std::size_t row,
                                                  std::size_t joint) const noexcept {
  const double at = position(row, joint);
  std::array<double, 3> controls{at, at, at};
  if (motion_->velocities.empty()) return controls;
  const std::vector<double>& times = motion_->times;
  const double third = velocity(row, joint) / 3.0;
  if (row > 0) controls[1] -= third * (times[row] - times[row - 1]);
  if (row + 1 < times.size()) controls[2] += third * (times[row + 1] - times[row]);
  return controls;
}

void Trajectory::place(const Stretch& stretch, double at, std::span<TrackedVariable> variables,
                       std::span<VariableBounds> bounds) const noexcept {
  const bool one = stretch.is_in_one_segment();
  const std::size_t segment = one ? stretch.first : (stretch.first + stretch.last + 1) / 2;
  const bool cubic = !motion_->velocities.empty() && motion_->times.size() > 1;
  for (std::size_t joint = 0; joint < moved_.size(); ++joint) {
    const State now = state(segment, joint, at);
    TrackedVariable& variable = variables[moved_[joint]];
    variable.position = now.position;
    variable.velocity = now.speed;
    VariableBounds& bound = bounds[moved_[joint]];
    bound = {};
    if (one) {
      const double half = rounded_up(std::max(stretch.to - at, at - stretch.from));
      bound.speed = std::abs(now.speed);
      bound.deviation = half * bound.speed;
      if (cubic) {
        bound.acceleration = (1.0 + kTrajectoryRounding) * largest_acceleration(segment, joint);
        bound.deviation += 0.5 * half * half * bound.acceleration;
        bound.speed += half * bound.acceleration;
      }
    } else {
      for (std::size_t row = stretch.first; row <= stretch.last + 1; ++row) {
        bound.deviation = std::max(bound.deviation, std::abs(position(row, joint) - now.position));
      }
      for (std::size_t i = stretch.first; cubic && i <= stretch.last; ++i) {
        const double ends = std::max(std::abs(position(i, joint) - now.position),
                                     std::abs(position(i + 1, joint) - now.position));
        bound.deviation = std::max(bound.deviation, ends + bulge(i, joint));
      }
    }
    bound.deviation = (1.0 + kTrajectoryRounding) * bound.deviation;
    bound.speed = (1.0 + kTrajectoryRounding) * bound.speed;
  }
}

}  // namespace clearance
