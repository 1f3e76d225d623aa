#include "monitor/bodies/interpolated_motion.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/displacement.hpp"

namespace clearance {
namespace {

// The shorter rotation from one orientation to the other; either one if both are equally short.
Vec3 turn_between(const Eigen::Quaterniond& before, const Eigen::Quaterniond& after) noexcept {
  const Eigen::Quaterniond q = after.normalized() * before.normalized().conjugate();
  const double sine = q.vec().norm();
  if (!(sine > 0.0)) return Vec3::Zero();
  const double angle = 2.0 * std::atan2(sine, std::abs(q.w()));
  return std::copysign(angle / sine, q.w()) * q.vec();
}

Eigen::Quaterniond turned(const Eigen::Quaterniond& orientation, const Vec3& turn) noexcept {
  const double angle = turn.norm();
  if (!(angle > 0.0)) return orientation;
  const Vec3 half = std::sin(0.5 * angle) / angle * turn;
  return Eigen::Quaterniond(std::cos(0.5 * angle), half.x(), half.y(), half.z()) *
         orientation.normalized();
}

double angle_of(const InterpolatedMotion& motion) noexcept {
  return motion.turns ? motion.turn.norm() + kTurnRounding : 0.0;
}

}  // namespace

InterpolatedMotion interpolated_motion(const Pose& from, const Pose& to) noexcept {
  InterpolatedMotion motion{.from = from, .to = to};
  motion.shift = to.position - from.position;
  motion.turns = from.orientation.coeffs() != to.orientation.coeffs();
  if (motion.turns) motion.turn = turn_between(from.orientation, to.orientation);
  return motion;
}

Pose pose_at(const InterpolatedMotion& motion, double s) noexcept {
  if (s <= 0.0) return motion.from;
  if (s >= 1.0) return motion.to;
  Pose pose = motion.from;
  pose.position += s * motion.shift;
  if (motion.turns) pose.orientation = turned(motion.from.orientation, s * motion.turn);
  return pose;
}

RelativeMotion seen_from(const InterpolatedMotion& resting, const InterpolatedMotion& moving,
                         const Vec3& centre, double radius) noexcept {
  const Vec3 arm = centre - moving.from.position;
  const Vec3 from_resting = centre - resting.from.position;
  const double length = arm.norm();
  const double turn = angle_of(moving), turn_of_frame = angle_of(resting);
  // `start` is the initial velocity of the sphere's centre, less that of the other frame at the
  // same point. `change` bounds how much it varies while both rotate and the centre moves.
  const Vec3 start =
      moving.shift + moving.turn.cross(arm) - resting.shift - resting.turn.cross(from_resting);
  const double between_origins = (moving.shift - resting.shift).norm();
  const double change = turn * turn * length + turn_of_frame * (between_origins + turn * length);
  const double error = kVelocityError * (moving.shift.norm() + resting.shift.norm() +
                                         turn * length + turn_of_frame * from_resting.norm()) +
                       (moving.turns ? kTurnRounding * length : 0.0) +
                       (resting.turns ? kTurnRounding * from_resting.norm() : 0.0);
  const double of_middle = start.norm() + change + error;
  const bool turns = moving.turns || resting.turns;
  const double turning = turns ? (moving.turn - resting.turn).norm() + 2.0 * kTurnRounding : 0.0;

  RelativeMotion motion;
  motion.turning = rounded_up(swept(turning, radius));
  motion.speed = rounded_up(of_middle + motion.turning);
  motion.bending = rounded_up(rounded_up(change + turn_of_frame * of_middle) + error);
  return motion;
}

}  // namespace clearance
