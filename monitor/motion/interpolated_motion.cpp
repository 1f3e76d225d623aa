#include "monitor/motion/interpolated_motion.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// Logarithm, sine, cosine and a product of quaternions, a sum of positions: each within a few 2^-52
// of what it is exactly.
constexpr double kWayError = 0x1p-47;

// From one orientation to the other; either way round, where both are equally short.
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

double angle_of(const InterpolatedMotion& way) noexcept {
  return way.turns ? way.turn.norm() + kTurnRounding : 0.0;
}

}  // namespace

InterpolatedMotion way_of(const TrackedObject& object) noexcept {
  InterpolatedMotion way{.from = object.moved ? object.pose_before : object.pose,
                         .to = object.pose};
  way.shift = way.to.position - way.from.position;
  way.turns = way.from.orientation.coeffs() != way.to.orientation.coeffs();
  if (way.turns) way.turn = turn_between(way.from.orientation, way.to.orientation);
  return way;
}

Pose pose_on_way(const InterpolatedMotion& way, double s) noexcept {
  if (s <= 0.0) return way.from;
  if (s >= 1.0) return way.to;
  Pose pose = way.from;
  pose.position += s * way.shift;
  if (way.turns) pose.orientation = turned(way.from.orientation, s * way.turn);
  return pose;
}

void place_on_way(const InterpolatedMotion& way, double s, PosedPart& part) noexcept {
  place_at(pose_on_way(way, s), part);
  if (s <= 0.0 || s >= 1.0) return;
  const double reach = way.from.position.norm() + way.to.position.norm();
  const double offset = way.turns ? part.object_from_part.position.norm() : 0.0;
  part.shift_error += kWayError * (reach + offset);
  if (way.turns) part.turn_error += kWayError;
}

RelativeMotion seen_from(const InterpolatedMotion& resting, const InterpolatedMotion& moving,
                         const PosedPart& part) noexcept {
  const Vec3& middle = part.sphere_in_world.centre;
  const Vec3 arm = middle - moving.from.position;
  const Vec3 from_resting = middle - resting.from.position;
  const double length = arm.norm();
  const double turn = angle_of(moving), turn_of_frame = angle_of(resting);
  // What the middle does, less what the other's frame does at that point; at the beginning, and how
  // much that changes as both turn and the middle moves on.
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
  motion.turning = rounded_up(swept(turning, part.sphere_in_world.radius));
  motion.speed = rounded_up(of_middle + motion.turning);
  motion.bending = rounded_up(rounded_up(change + turn_of_frame * of_middle) + error);
  return motion;
}

}  // namespace clearance
