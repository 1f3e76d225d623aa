#include "monitor/closing.hpp"

#include <cmath>
#include <limits>

namespace clearance {

Vec3 velocity_at(const Vec3& point_in_world, const Pose& world_from_body,
                 const Twist& twist) noexcept {
  return twist.linear + twist.angular.cross(point_in_world - world_from_body.position);
}

double closing_speed(const Vec3& velocity_a, const Vec3& velocity_b, const Vec3& normal) noexcept {
  return normal.dot(velocity_a - velocity_b);
}

double time_to_contact(double distance, double closing_speed) noexcept {
  if (std::isnan(distance)) return distance;
  if (closing_speed <= 0.0) return std::numeric_limits<double>::infinity();
  return distance <= 0.0 ? 0.0 : distance / closing_speed;
}

}  // namespace clearance
