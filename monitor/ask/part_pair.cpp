// README.md proves the two bounds, "of first order" and "of second order".
#include "monitor/ask/part_pair.hpp"

#include <algorithm>
#include <cmath>

#include "core/distance.hpp"
#include "core/model/curved_extent.hpp"
#include "core/model/support_function.hpp"
#include "monitor/geometry/bounding_sphere.hpp"
#include "monitor/kinematics/fixed_order.hpp"
#include "monitor/motion/directed_rounding.hpp"
#include "monitor/pairs/evaluate_pair.hpp"

namespace clearance {
namespace {

// The rounding of directions, velocities and support values, relative to the lengths in them.
constexpr double kSlabRounding = 0x1p-44;

Vec3 times_transposed(const Mat3& m, const Vec3& v) noexcept {
  return {(m(0, 0) * v.x() + m(1, 0) * v.y()) + m(2, 0) * v.z(),
          (m(0, 1) * v.x() + m(1, 1) * v.y()) + m(2, 1) * v.z(),
          (m(0, 2) * v.x() + m(1, 2) * v.y()) + m(2, 2) * v.z()};
}

// The greatest d.(x - c) over the points x of a bounded part, where c is the centre of its sphere,
// rounded up. d: in the world, of any length.
double support_about_centre(const PosedPart& part, const Vec3& d) noexcept {
  const double length = std::sqrt(dot(d, d));
  if (!(length > 0.0)) return 0.0;
  const Vec3 m = times_transposed(part.world_from_part_rotation, d) / length;
  const ConvexBody& shape = *part.shape;
  const double value = shape.is_curved() ? support_value(shape.curved, m) : support(shape, m).value;
  const double error = shape.position_error + kSlabRounding * (part.extent + part.sphere_offset);
  return length * (value - dot(m, part.sphere_in_part.centre) + shape.radius + error);
}

// The motion of the tip in the frame of the base at one instant: a point x moves at
// linear + angular x (x - centre of the tip's sphere).
Twist relative_twist(const PartPair& pair, const Posture& posture, const Vec3& centre) noexcept {
  Vec3 base_origin, tip_origin;
  const Twist base = posture.twist(pair.object_base, base_origin);
  const Twist tip = posture.twist(pair.object_tip, tip_origin);
  return {(tip.linear + cross(tip.angular, centre - tip_origin)) -
              (base.linear + cross(base.angular, centre - base_origin)),
          tip.angular - base.angular};
}

// Lower bound of the distance over the stretch by the slab that separates the bodies at its middle.
// The slab stays in the base's frame.
double by_slab(const DistanceResult& found, double lower, double half, double acceleration,
               const PosedPart& base, const PosedPart& tip, const Twist& twist) noexcept {
  const Mat3& turn = base.world_from_part_rotation;
  const Vec3 n = times(turn, found.normal);
  const Vec3 on_tip = times(turn, found.point_on_b) + base.world_from_part.position;
  const Vec3& centre = tip.sphere_in_world.centre;
  const Vec3 m = cross(n, twist.angular);
  const double along = dot(n, twist.linear), arm = dot(n, on_tip - centre);
  double least = kInfinity;
  for (const double t : {-half, half}) {
    least = std::min(least, t * along - support_about_centre(tip, -(n + t * m)));
  }
  // Only a half-space has points without bound, and its normal is that of its facet.
  const double size = (base.shape->is_half_space() ? 0.0 : base.extent) + tip.extent +
                      tip.sphere_in_world.radius + std::abs(lower) +
                      half * (std::sqrt(dot(twist.linear, twist.linear)) +
                              std::sqrt(dot(twist.angular, twist.angular)) * tip.extent);
  return lower + least - arm - rounded_up(0.5 * acceleration * half * half) - kSlabRounding * size;
}

}  // namespace

StretchBounds bounds_over(const Stretch& stretch, double middle, double enough, double begin,
                          Posture& posture, PartPair& pair) noexcept {
  const PosedPart& base = posture.part(pair.base);
  const PosedPart& tip = posture.part(pair.tip);
  const double moved =
      posture.chains().displacement(pair.chain, tip.sphere_in_world, posture.bounds());
  const double loss =
      rounded_up(pair.rounding + swept(pair.unstated_speed, stretch.to - begin + pair.age));
  StretchBounds bounds;
  bounds.lower =
      rounded_down(least_between(base.sphere_in_world, tip.sphere_in_world) - moved - loss);
  if (bounds.lower >= enough) return bounds;

  bounds.queried = true;
  const RelativePose pose = relative_pose(base.world_from_part, tip.world_from_part);
  DistanceResult found = distance(*base.shape, *tip.shape, pose, pair.tracking, {.depth = false});
  // Only the depth certifies that the bodies overlap.
  if (found.status == DistanceStatus::kDepthNotAsked) {
    found = distance(*base.shape, *tip.shape, pose, pair.tracking);
  }
  const DistanceBounds exact = for_exact_poses(found, base, tip);
  const double now = swept(pair.unstated_speed, middle - begin + pair.age);
  bounds.upper = std::max(0.0, rounded_up(exact.upper + pair.rounding - now));
  bounds.lower = std::max(bounds.lower, rounded_down(exact.lower - moved - loss));
  const Mat3& turn = base.world_from_part_rotation;
  bounds.on_base = times(turn, found.point_on_a) + base.world_from_part.position;
  bounds.on_tip = times(turn, found.point_on_b) + base.world_from_part.position;

  const bool separated = found.status == DistanceStatus::kConverged && exact.lower > 0.0;
  const bool directed = base.keeps_direction && tip.keeps_direction && std::isfinite(tip.extent);
  if (separated && directed && stretch.is_in_one_segment() && moved > 0.0) {
    const Twist twist = relative_twist(pair, posture, tip.sphere_in_world.centre);
    const double half = rounded_up(std::max(stretch.to - middle, middle - stretch.from));
    const double slab =
        by_slab(found, exact.lower, half,
                posture.chains().acceleration(pair.chain, posture.bounds()), base, tip, twist);
    bounds.lower = std::max(bounds.lower, rounded_down(slab - loss));
    const Vec3 n = times(turn, found.normal);
    bounds.closing =
        -dot(n, twist.linear + cross(twist.angular, bounds.on_tip - tip.sphere_in_world.centre));
  }
  if (std::isnan(bounds.lower)) bounds.lower = -kInfinity;
  return bounds;
}

}  // namespace clearance
