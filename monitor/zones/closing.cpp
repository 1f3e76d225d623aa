// A point at r from the body's origin has the velocity v + w x r. Its component along n is
// n.v + r.(n x w), at most n.v + |n x w| |r|.
#include "monitor/zones/closing.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/closing_speed.hpp"
#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {

double speed_towards(const TrackedObject& body, const Vec3& towards, const Vec3& witness,
                     double max_speed) noexcept {
  const Vec3 &v = body.twist.linear, &w = body.twist.angular;
  const bool directed = towards.allFinite();
  const double linear = directed ? towards.dot(v) : v.norm();
  const double turning = directed ? towards.cross(w).norm() : w.norm();
  const double of_turn = swept(turning, body.bounding_radius);
  const double rounding = kVelocityError * (v.norm() + swept(w.norm(), body.bounding_radius));
  const double any_point = rounded_up(linear + of_turn + (rounding < kInfinity ? rounding : 0.0));
  const Vec3 of_witness = witness.allFinite() ? velocity_at(witness, body.pose, body.twist) : v;
  const double at_witness = (directed ? towards.dot(of_witness) : of_witness.norm()) + rounding;
  return std::max({0.0, std::min(any_point, max_speed), std::min(at_witness, any_point)});
}

}  // namespace clearance
