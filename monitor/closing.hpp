// How fast do two bodies close, and when would they touch if they went on like that?
#pragma once

#include <cmath>
#include <limits>

#include "core/pose.hpp"

namespace clearance {

// Velocity of the body's point that is at `point_in_world` now, m/s.
[[nodiscard]] inline Vec3 velocity_at(const Vec3& point_in_world, const Pose& world_from_body,
                                      const Twist& twist) noexcept {
  return twist.linear + twist.angular.cross(point_in_world - world_from_body.position);
}

// m/s, positive when approaching; `normal` is a unit vector from A towards B. NaN without a normal.
[[nodiscard]] inline double closing_speed(const Vec3& velocity_a, const Vec3& velocity_b,
                                          const Vec3& normal) noexcept {
  return normal.dot(velocity_a - velocity_b);
}

// s. Infinity when not approaching. In contact (distance <= 0): 0, unless the two are known to be
// parting. NaN for a distance, or apart for a closing speed, that is not known.
[[nodiscard]] inline double time_to_contact(double distance, double closing_speed) noexcept {
  if (std::isnan(distance)) return distance;
  if (closing_speed <= 0.0) return std::numeric_limits<double>::infinity();
  return distance <= 0.0 ? 0.0 : distance / closing_speed;
}

}  // namespace clearance
