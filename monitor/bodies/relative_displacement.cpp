#include "monitor/bodies/relative_displacement.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_body.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// Above this angle, rad, the vector part of a quaternion is too loose a bound of the angle.
constexpr double kMostTurn = 1.0;

// The rotation from the last pose to the one in use: 2 sin(angle / 2) along the axis of the smaller
// angle, in the world.
Vec3 turning_of(const BodyMotion& body) noexcept {
  if (body.motion.turn == 0.0) return Vec3::Zero();
  const Eigen::Quaterniond q =
      body.now.orientation.normalized() * body.before.orientation.normalized().conjugate();
  return std::copysign(2.0, q.w()) * q.vec();
}

// The largest difference between turning_of() and the rotation vector, rad. With v its half, |v| =
// sin(angle / 2) <= 1/2, the difference is 2 (asin |v| - |v|) <= 0.38 |v|^3. The excess of the
// angle over 4 sin(angle / 4) is no larger.
double turn_error(const Motion& motion) noexcept {
  return motion.turn == 0.0 ? 0.0
                            : 0.0625 * motion.turn * motion.turn * motion.turn + kTurnRounding;
}

}  // namespace

double relative_displacement(const BodyMotion& a, const BodyMotion& b) noexcept {
  const bool from_a = b.bounding_radius <= a.bounding_radius;
  const BodyMotion& resting = from_a ? a : b;
  const BodyMotion& moving = from_a ? b : a;
  const Motion& frame = resting.motion;
  const Motion& body = moving.motion;
  if (!(std::max(frame.turn, body.turn) <= kMostTurn)) return kInfinity;

  const Vec3 shift = (moving.now.position - moving.before.position) -
                     (resting.now.position - resting.before.position);
  const Vec3 turning_frame = turning_of(resting), turning_body = turning_of(moving);
  const Vec3 between = moving.before.position - resting.before.position;
  const double distance = between.norm(), shifted = shift.norm() + kShiftUnderflow;
  const double frame_turn = frame.turn + turn_error(frame);
  const double turning =
      (turning_body - turning_frame).norm() + turn_error(body) + turn_error(frame);
  const double of_origin = (shift - turning_frame.cross(between)).norm() + kShiftUnderflow +
                           turn_error(frame) * distance + frame_turn * shifted;
  const double sizes = frame.shift + body.shift + frame_turn * (distance + shifted);
  return rounded_up(of_origin + swept(turning, moving.bounding_radius) + kVelocityError * sizes);
}

}  // namespace clearance
