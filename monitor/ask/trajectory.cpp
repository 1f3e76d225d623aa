#include "monitor/ask/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {
namespace {

// A bound of some ten roundings, relative to the numbers that take part.
constexpr double kTrajectoryRounding = 0x1p-48;
// Let p be the largest magnitude of a position, or of a velocity times the length. Linear: the
// position rounds by at most 11 x 2^-53 p, and a speed within half a segment by 3 x 2^-53 p.
constexpr double kLinearRounding = 0x1p-49;
// Cubic: the terms cancel, so that errors are relative to p alone. Adding them up, term by term,
// gives 238 x 2^-53 p for positions, 431 for a speed times the length of the segment, and 550 for
// an acceleration times its square.
constexpr double kCubicPositionRounding = 0x1p-44;
constexpr double kCubicRounding = 0x1p-43;

bool all_within(const std::vector<double>& numbers, double limit) noexcept {
  return std::all_of(numbers.begin(), numbers.end(),
                     [limit](double x) { return std::abs(x) <= limit; });
}

// A robot cannot be at two places at one time. A waypoint may be stated twice.
bool jumps(const JointTrajectory& motion, std::size_t row) noexcept {
  const std::size_t joints = motion.joints.size();
  const double* here = motion.positions.data() + row * joints;
  return !std::equal(here, here + joints, here - joints);
}

std::optional<std::string> fault(const JointTrajectory& motion) {
  const std::size_t rows = motion.times.size(), joints = motion.joints.size();
  if (rows == 0 || joints == 0) return "the motion has no waypoint or no joint";
  if (motion.positions.size() != rows * joints) {
    return "the motion has " + std::to_string(motion.positions.size()) + " positions; expected " +
           std::to_string(joints) + " for each of " + std::to_string(rows) + " times";
  }
  if (!motion.velocities.empty() && motion.velocities.size() != motion.positions.size()) {
    return "the motion needs as many velocities as positions, or none";
  }
  if (!motion.deviations.empty() && motion.deviations.size() != joints)
    return "the motion needs a deviation for each joint, or none";
  if (!all_within(motion.times, 1e9)) return "a time is not a finite number of at most 1e9 s";
  if (!all_within(motion.positions, kLargestJoint) ||
      !all_within(motion.velocities, kLargestJoint)) {
    return "a position or velocity is not finite, or larger than 1e6";
  }
  for (std::size_t i = 1; i < rows; ++i) {
    const double step = motion.times[i] - motion.times[i - 1];
    if (step >= kShortestStep) continue;
    if (step > 0.0) {
      return "the time of waypoint " + std::to_string(i) +
             " is less than 1e-20 s after that of the one before; expected the same time, or a "
             "longer step";
    }
    if (motion.times[i] == motion.times[i - 1] && !jumps(motion, i)) continue;
    return "the time of waypoint " + std::to_string(i) +
           " is not after that of the one before, and its positions are others";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::uint32_t> variable_named(const Scene& scene, const std::string& name) noexcept {
  for (std::uint32_t i = 0; i < scene.variables.size(); ++i) {
    if (scene.variables[i].name == name) return i;
  }
  return std::nullopt;
}

void find_rows(std::span<const double> timeline, std::span<const double> own,
               std::vector<std::int32_t>& rows) {
  rows.clear();
  std::int32_t row = kBeforeFirstRow;
  const std::size_t segments = timeline.size() < 2 ? 1 : timeline.size() - 1;
  for (std::size_t segment = 0; segment < segments; ++segment) {
    while (static_cast<std::size_t>(row + 1) < own.size() &&
           own[static_cast<std::size_t>(row + 1)] <= timeline[segment]) {
      ++row;
    }
    rows.push_back(row);
  }
}

Trajectory::Trajectory(std::size_t variables) { moved_.reserve(variables); }

std::optional<std::string> Trajectory::add_track(const JointTrajectory& motion,
                                                 const Scene& scene) {
  if (std::optional<std::string> text = fault(motion)) return text;
  Track track{.motion = &motion,
              .first_joint = static_cast<std::uint32_t>(moved_.size()),
              .joints = static_cast<std::uint32_t>(motion.joints.size()),
              .rows_of = static_cast<std::uint32_t>(tracks_.size())};
  for (const std::string& joint : motion.joints) {
    const std::optional<std::uint32_t> variable = variable_named(scene, joint);
    if (!variable) return "the cell has no joint \"" + joint + "\"";
    if (std::find(moved_.begin(), moved_.end(), *variable) != moved_.end()) {
      return "joint \"" + joint + "\" is named twice";
    }
    moved_.push_back(*variable);
  }
  tracks_.push_back(track);
  return std::nullopt;
}

std::optional<std::string> Trajectory::take(const Question& question, const Scene& scene) {
  moved_.clear();
  tracks_.clear();
  if (std::optional<std::string> text = add_track(question.motion, scene)) return text;
  for (const JointTrajectory& motion : question.beside) {
    if (std::optional<std::string> text = add_track(motion, scene)) {
      return *text + " (in a motion beside the one in question)";
    }
  }
  make_timeline(question);
  largest_position_ = 0.0;
  bool any_cubic = false;
  for (const Track& track : tracks_) {
    any_cubic = any_cubic || track.is_cubic();
    for (const double p : track.motion->positions) {
      largest_position_ = std::max(largest_position_, std::abs(p));
    }
    const double length = track.motion->times.back() - track.motion->times.front();
    for (const double v : track.motion->velocities) {
      largest_position_ = std::max(largest_position_, std::abs(v) * length);
    }
  }
  position_rounding_ = (any_cubic ? kCubicPositionRounding : kLinearRounding) * largest_position_;
  return std::nullopt;
}

void Trajectory::make_timeline(const Question& question) {
  const std::vector<double>& own = question.motion.times;
  times_.assign(own.begin(), own.end());
  const auto add = [&](const std::vector<double>& times) {
    for (const double t : times) {
      if (own.front() < t && t < own.back()) times_.push_back(t);
    }
  };
  for (const JointTrajectory& motion : question.beside) add(motion.times);
  for (const ObjectMotion& motion : question.moving) add(motion.times);
  if (times_.size() > own.size()) std::sort(times_.begin(), times_.end());
  times_.erase(std::unique(times_.begin(), times_.end()), times_.end());
  if (rows_.size() < tracks_.size()) rows_.resize(tracks_.size());
  for (const Track& track : tracks_) find_rows(times_, track.motion->times, rows_[track.rows_of]);
}

void Trajectory::go_on(double time, std::span<const double> velocities) {
  Track& track = tracks_.front();
  const double end = track.motion->times.back();
  if (!track.onward.empty()) times_.pop_back();
  // A motion of one waypoint has one segment already.
  const bool adds_segment = track.onward.empty() && times_.size() > 1;
  for (const Track& each : tracks_)
    if (adds_segment) rows_[each.rows_of].push_back(each.last_row());
  track.onward = velocities;
  track.onward_time = time;
  times_.push_back(end + time);
  for (std::size_t joint = 0; joint < track.joints; ++joint)
    largest_position_ =
        std::max(largest_position_, std::abs(track.position(track.rows() - 1, joint)));
  position_rounding_ =
      (track.is_cubic() ? kCubicPositionRounding : kLinearRounding) * largest_position_;
}

// The velocity is quadratic in time.
VelocityRange Trajectory::velocities(std::size_t joint, const Stretch& stretch) const noexcept {
  const Track& track = tracks_.front();
  const std::int32_t row = rows_[track.rows_of][stretch.first];
  const State from = state(track, row, joint, stretch.from);
  const State to = state(track, row, joint, stretch.to);
  VelocityRange range{std::min(from.speed, to.speed), std::max(from.speed, to.speed)};
  if (from.acceleration == 0.0 && from.jerk == 0.0) return range;
  if (from.acceleration * to.acceleration < 0.0) {
    const double turn = from.speed - 0.5 * from.acceleration * (from.acceleration / from.jerk);
    range = {std::min(range.least, turn), std::max(range.most, turn)};
  }
  const double size = std::max(range.largest_speed(), std::abs(from.speed));
  const double rounding =
      kCubicRounding * largest_position_ / length_of(track, row) + kTrajectoryRounding * size;
  return {range.least - rounding, range.most + rounding};
}

double Trajectory::last_velocity(std::size_t joint) const noexcept {
  const Track& track = tracks_.front();
  const std::vector<double>& times = track.motion->times;
  if (!track.motion->velocities.empty()) return track.velocity(times.size() - 1, joint);
  for (std::size_t row = times.size() - 1; row > 0; --row) {
    if (times[row] == times[row - 1]) continue;
    return (track.position(row, joint) - track.position(row - 1, joint)) /
           (times[row] - times[row - 1]);
  }
  return 0.0;
}

Stretch Trajectory::whole() const noexcept { return {0, segments() - 1, begin(), end()}; }

double Trajectory::middle(const Stretch& stretch) const noexcept {
  if (!stretch.is_in_one_segment()) return times_[segment_at_middle(stretch)];
  return stretch.from + 0.5 * (stretch.to - stretch.from);
}

Stretch Trajectory::before(const Stretch& stretch, double middle) noexcept {
  if (stretch.is_in_one_segment()) return {stretch.first, stretch.first, stretch.from, middle};
  return {stretch.first, segment_at_middle(stretch) - 1, stretch.from, middle};
}

Stretch Trajectory::after(const Stretch& stretch, double middle) noexcept {
  if (stretch.is_in_one_segment()) return {stretch.first, stretch.first, middle, stretch.to};
  return {segment_at_middle(stretch), stretch.last, middle, stretch.to};
}

// The cubic p0 + v0 t + ... of Hermite. Its acceleration is linear in time.
Trajectory::State Trajectory::state(const Track& track, std::int32_t row, std::size_t joint,
                                    double at) noexcept {
  const std::vector<double>& times = track.motion->times;
  if (row < 0) return {track.position(0, joint), 0.0, 0.0, 0.0};
  const auto r = static_cast<std::size_t>(row);
  const double p0 = track.position(r, joint);
  if (r + 1 >= times.size()) {
    if (track.onward.empty()) return {p0, 0.0, 0.0, 0.0};
    const double since = std::clamp(at - times[r], 0.0, track.onward_time);
    return {p0 + since * track.onward[joint], track.onward[joint], 0.0, 0.0};
  }
  const double length = times[r + 1] - times[r];
  const double t = std::clamp(at - times[r], 0.0, length), u = t / length;
  const double step = track.position(r + 1, joint) - p0, rate = step / length;
  if (track.motion->velocities.empty()) return {p0 + u * step, rate, 0.0, 0.0};
  const double v0 = track.velocity(r, joint), v1 = track.velocity(r + 1, joint);
  const double a = (6.0 * rate - 4.0 * v0 - 2.0 * v1) / length;  // at the start
  const double jerk = (6.0 * v0 + 6.0 * v1 - 12.0 * rate) / (length * length);
  return {p0 + t * (v0 + t * (0.5 * a + t * (jerk / 6.0))), v0 + t * (a + 0.5 * t * jerk),
          a + t * jerk, jerk};
}

double Trajectory::largest_acceleration(const Track& track, std::int32_t row,
                                        std::size_t joint) noexcept {
  const auto r = static_cast<std::size_t>(row);
  return std::max(std::abs(state(track, row, joint, track.time(r)).acceleration),
                  std::abs(state(track, row, joint, track.time(r + 1)).acceleration));
}

// A function whose second derivative is at most a leaves its chord by at most a length^2 / 8.
double Trajectory::bulge(const Track& track, std::int32_t row, std::size_t joint) noexcept {
  if (!track.is_cubic()) return 0.0;
  const auto r = static_cast<std::size_t>(row);
  const double length = track.time(r + 1) - track.time(r);
  if (length == 0.0) return 0.0;
  return 0.125 * length * length * largest_acceleration(track, row, joint);
}

std::array<double, 3> Trajectory::controls_beside(const Track& track, std::size_t row,
                                                  std::size_t joint) noexcept {
  const double at = track.position(row, joint);
  std::array<double, 3> controls{at, at, at};
  if (!track.is_cubic()) return controls;
  const std::vector<double>& times = track.motion->times;
  const double third = track.velocity(row, joint) / 3.0;
  if (row > 0) controls[1] -= third * (times[row] - times[row - 1]);
  if (row + 1 < times.size()) controls[2] += third * (times[row + 1] - times[row]);
  return controls;
}

void Trajectory::place_in_segment(const Track& track, const Stretch& stretch, double at,
                                  std::span<TrackedVariable> variables,
                                  std::span<VariableBounds> bounds) const noexcept {
  const std::int32_t row = rows_[track.rows_of][stretch.first];
  const double half = rounded_up(std::max(stretch.to - at, at - stretch.from));
  for (std::size_t joint = 0; joint < track.joints; ++joint) {
    const std::uint32_t moved = moved_[track.first_joint + joint];
    const State now = state(track, row, joint, at);
    variables[moved].position = now.position;
    variables[moved].velocity = now.speed;
    VariableBounds& bound = bounds[moved];
    bound.speed = std::abs(now.speed);
    bound.acceleration = 0.0;
    if (now.jerk != 0.0 || now.acceleration != 0.0 || now.speed != 0.0) {
      // The acceleration is linear in time, so it is largest at an end.
      const double length = length_of(track, row);
      const double rounding = track.is_cubic() ? kCubicRounding * largest_position_ / length : 0.0;
      bound.speed += rounding;
      bound.acceleration =
          std::abs(now.acceleration) + half * std::abs(now.jerk) + rounding / length;
      bound.acceleration *= 1.0 + kTrajectoryRounding;
    }
    bound.deviation = half * (bound.speed + 0.5 * half * bound.acceleration);
    bound.speed += half * bound.acceleration;
    bound.deviation *= 1.0 + kTrajectoryRounding;
    bound.speed *= 1.0 + kTrajectoryRounding;
  }
}

void Trajectory::place_at_waypoint(const Track& track, const Stretch& stretch, double at,
                                   std::span<TrackedVariable> variables,
                                   std::span<VariableBounds> bounds) const noexcept {
  const std::vector<std::int32_t>& rows = rows_[track.rows_of];
  const auto rows_of_motion = static_cast<std::int32_t>(track.rows());
  const std::int32_t now_row = rows[segment_at_middle(stretch)];
  const std::int32_t from = std::max(0, rows[stretch.first]);
  const std::int32_t to = std::min(rows_of_motion - 1, rows[stretch.last] + 1);
  for (std::size_t joint = 0; joint < track.joints; ++joint) {
    const std::uint32_t moved = moved_[track.first_joint + joint];
    const State now = state(track, now_row, joint, at);
    variables[moved].position = now.position;
    variables[moved].velocity = now.speed;
    VariableBounds& bound = bounds[moved];
    bound = {};
    double last = std::abs(track.position(static_cast<std::size_t>(from), joint) - now.position);
    bound.deviation = last;
    for (std::int32_t row = from; row < to; ++row) {
      const double next =
          std::abs(track.position(static_cast<std::size_t>(row) + 1, joint) - now.position);
      bound.deviation = std::max(bound.deviation, std::max(last, next) + bulge(track, row, joint));
      last = next;
    }
    bound.deviation *= 1.0 + kTrajectoryRounding;
  }
}

void Trajectory::place(const Stretch& stretch, double at, std::span<TrackedVariable> variables,
                       std::span<VariableBounds> bounds) const noexcept {
  for (const Track& track : tracks_) {
    if (stretch.is_in_one_segment()) {
      place_in_segment(track, stretch, at, variables, bounds);
    } else {
      place_at_waypoint(track, stretch, at, variables, bounds);
    }
  }
}

}  // namespace clearance
