#include "monitor/ask/moving_objects.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/ask/vectors.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/fixed_order.hpp"
#include "monitor/bodies/sine_cosine.hpp"

namespace clearance {
namespace {

constexpr double kMotionRounding = 0x1p-46;

std::string named(const ObjectMotion& motion) {
  return "the motion of object \"" + motion.object + "\" ";
}

std::optional<std::string> fault(const ObjectMotion& motion) {
  if (motion.times.empty() || motion.times.size() != motion.world_from_object.size())
    return named(motion) + "needs as many poses as times, and at least one";
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    if (!(std::abs(motion.times[i]) <= 1e9))
      return named(motion) + "has a time that is not a finite number of at most 1e9 s";
    if (i > 0 && !(motion.times[i] - motion.times[i - 1] >= kShortestStep))
      return named(motion) + "has times that do not increase by 1e-20 s or more";
    const Pose& pose = motion.world_from_object[i];
    if (!is_unit(pose.orientation) || !pose.position.allFinite())
      return named(motion) + "has a pose that is not finite, or not of unit length";
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> MovingObjects::take(const Question& question,
                                               std::span<const std::uint32_t> objects,
                                               std::span<const double> timeline) {
  motions_ = question.moving;
  states_.resize(motions_.size());
  if (rows_.size() < motions_.size()) {
    rows_.resize(motions_.size());
    turns_.resize(motions_.size());
  }
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (auto text = fault(motions_[i])) return text;
    states_[i] = {};
    states_[i].object = objects[i];
    find_rows(timeline, motions_[i].times, rows_[i]);
    turns_[i].clear();
    for (std::size_t row = 1; row < motions_[i].times.size(); ++row) {
      const auto& from = motions_[i].world_from_object[row - 1].orientation;
      const auto& to = motions_[i].world_from_object[row].orientation;
      Eigen::Quaterniond between = product(from.conjugate(), to);
      if (between.w() < 0.0) between.coeffs() = -between.coeffs();
      const double sine = length(between.vec());
      Turn turn;
      if (sine > 0.0) {
        turn.axis = between.vec() / sine;
        turn.angle = 2.0 * std::atan2(sine, between.w());
      }
      turns_[i].push_back(turn);
    }
  }
  return std::nullopt;
}

void MovingObjects::rest(const Pose& pose, ObjectState& state) const noexcept {
  state.pose = pose;
  state.velocity = state.angular = Vec3::Zero();
}

void MovingObjects::place(const Stretch& stretch, double at) noexcept {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const std::vector<double>& times = motions_[i].times;
    const std::vector<Pose>& poses = motions_[i].world_from_object;
    const auto last = static_cast<std::int32_t>(times.size()) - 1;
    ObjectState& state = states_[i];
    state.shift = state.turn = 0.0;
    const std::int32_t now = rows_[i][Trajectory::segment_at_middle(stretch)];
    if (now < 0 || now == last) {
      rest(poses[static_cast<std::size_t>(std::max(0, now))], state);
    } else {
      const auto row = static_cast<std::size_t>(now);
      const double span = times[row + 1] - times[row];
      const double u = std::clamp((at - times[row]) / span, 0.0, 1.0);
      const Vec3 step = poses[row + 1].position - poses[row].position;
      const Turn& turn = turns_[i][row];
      const SineCosine half = sine_cosine(0.5 * u * turn.angle);
      const Vec3 sine = half.sine * turn.axis;
      state.velocity = step / span;
      state.angular = clearance::times(rotation_matrix(poses[row].orientation), turn.axis) *
                      (turn.angle / span);
      state.pose.position = poses[row].position + u * step;
      state.pose.orientation =
          product(poses[row].orientation, {half.cosine, sine.x(), sine.y(), sine.z()});
      state.pose.orientation.normalize();
      if (stretch.is_in_one_segment()) {
        const double most = std::max(stretch.to - at, at - stretch.from);
        state.shift = most * length(state.velocity);
        state.turn = most * turn.angle / span;
      }
    }
    if (!stretch.is_in_one_segment()) {
      const std::int32_t from = std::max(0, rows_[i][stretch.first]);
      const std::int32_t to = std::min(last, rows_[i][stretch.last] + 1);
      for (std::int32_t row = from; row <= to; ++row) {
        const auto r = static_cast<std::size_t>(row);
        state.shift = std::max(state.shift, length(poses[r].position - state.pose.position));
        if (row < to) state.turn += turns_[i][r].angle;
      }
    }
    state.shift = rounded_up((1.0 + kMotionRounding) * state.shift +
                             kMotionRounding * length(state.pose.position));
    state.turn = rounded_up((1.0 + kMotionRounding) * state.turn + kMotionRounding);
  }
}

}  // namespace clearance
