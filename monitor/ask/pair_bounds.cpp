// README.md proves the bounds, "of first order" and "of second order".
#include "monitor/ask/pair_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "core/distance.hpp"
#include "core/model/curved_extent.hpp"
#include "core/model/support_function.hpp"
#include "monitor/ask/vectors.hpp"
#include "monitor/bodies/bounding_sphere.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/bodies/fixed_order.hpp"
#include "monitor/pairs/evaluate_pair.hpp"

namespace clearance {
namespace {

// The rounding of directions, velocities and support values, relative to the lengths in them.
constexpr double kSlabRounding = 0x1p-44;

// The greatest d.(x - c) over the points x of a bounded part, where c is the centre of its sphere,
// rounded up. d: in the world, of any length.
double support_about_centre(const PosedPart& part, const Vec3& d) noexcept {
  const double size = length(d);
  if (!(size > 0.0)) return 0.0;
  const Vec3 m = times_transposed(part.world_from_part_rotation, d) / size;
  const ConvexBody& shape = *part.shape;
  const double value = shape.is_curved() ? support_value(shape.curved, m) : support(shape, m).value;
  const double error = shape.position_error + kSlabRounding * (part.extent + part.sphere_offset);
  return size * (value - dot(m, part.sphere_in_part.centre) + shape.radius + error);
}

// The distance of a sphere from a box around a part.
double gap_to_box(const PosedPart& part, const PartBox& box, const Sphere& sphere) noexcept {
  const Vec3& origin = part.world_from_part.position;
  const Vec3 p = times_transposed(part.world_from_part_rotation, sphere.centre - origin);
  double sum = 0.0, sizes = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double outside = std::max(0.0, std::max(box.low[i] - p[i], p[i] - box.high[i]));
    sum += outside * outside;
    sizes += std::abs(sphere.centre[i]) + 2.0 * std::abs(origin[i]);
  }
  const double error = part.shift_error + (part.turn_error + kSlabRounding) * sizes;
  return rounded_down(std::sqrt(sum)) - rounded_up(sphere.radius + error);
}

// Lower bound of the distance over the stretch by the slab that separates the bodies at its middle.
// The slab stays in the base's frame. `linear`: of the tip's centre.
double by_slab(const PairAtMiddle& found, const PosedPart& base, const PosedPart& tip,
               const Vec3& linear, const Vec3& angular, double half, double bend,
               double enough) noexcept {
  const Vec3& n = found.normal;
  const Vec3& centre = tip.sphere_in_world.centre;
  const double radius = tip.sphere_in_world.radius;
  const Vec3 m = cross(n, angular), arm_to_tip = found.on_tip - centre;
  const double along = dot(n, linear), arm = dot(n, arm_to_tip), turning = length(m);
  // Only a half-space has points without bound, and its normal is that of its facet.
  const double size = (base.shape->is_half_space() ? 0.0 : base.extent) + tip.extent + radius +
                      std::abs(found.lower) + length(arm_to_tip) +
                      half * (length(linear) + length(angular) * (tip.extent + length(arm_to_tip)));
  const double error = bend + kSlabRounding * size;
  const double at_witness = along + dot(m, arm_to_tip);
  const double roughly =
      found.lower - half * (std::abs(at_witness) + turning * (length(arm_to_tip) + radius)) - error;
  if (roughly >= enough) return roughly;
  double least = kInfinity;
  for (const double t : {-half, half}) {
    least = std::min(least, t * along - support_about_centre(tip, -(n + t * m)));
  }
  return std::max(roughly, found.lower + least - arm - error);
}

}  // namespace

TipMotion tip_motion(const Bundle& bundle, const Stretch& stretch, double middle,
                     Posture& posture) noexcept {
  const PosedPart& tip = posture.part(bundle.tip);
  const Sphere& sphere = tip.sphere_in_world;
  Chains& chains = posture.chains();
  TipMotion motion;
  motion.half = rounded_up(std::max(stretch.to - middle, middle - stretch.from));
  motion.moved = chains.displacement(bundle.chain, sphere, posture.bounds());
  motion.error = posture.trajectory().position_rounding() * bundle.sum_of_reaches +
                 posture.carrier_rounding(sphere, bundle.object_base) + bundle.model_error;
  if (posture.may_deviate(bundle.object_tip)) {
    motion.nearing = chains.nearing(bundle.chain, bundle.object_tip, sphere, posture.bounds(),
                                    posture.free_variables());
  }
  // A figure that is no number bounds nothing.
  if (std::isnan(motion.moved + motion.error)) motion.moved = motion.error = kInfinity;
  if (!stretch.is_in_one_segment()) return motion;
  motion.has_twist = true;
  Vec3 base_origin, tip_origin;
  const Twist of_tip = posture.twist(bundle.object_tip, tip_origin);
  motion.twist = {of_tip.linear + cross(of_tip.angular, sphere.centre - tip_origin),
                  of_tip.angular};
  if (bundle.base_is_link) {
    const Twist of_base = posture.twist(bundle.object_base, base_origin);
    motion.twist.linear -= of_base.linear + cross(of_base.angular, sphere.centre - base_origin);
    motion.twist.angular -= of_base.angular;
  } else if (bundle.base_carries_tip) {
    const Twist of_base = posture.twist_of_carrier(bundle.object_tip, base_origin);
    motion.twist.linear -= of_base.linear + cross(of_base.angular, sphere.centre - base_origin);
    motion.twist.angular -= of_base.angular;
  }
  motion.acceleration = chains.acceleration(bundle.chain, posture.bounds());
  const double bent = 0.5 * motion.acceleration * motion.half;
  const double speed =
      length(motion.twist.linear) + swept(length(motion.twist.angular), sphere.radius);
  motion.moved = std::min(motion.moved, (1.0 + kSlabRounding) * swept(motion.half, speed + bent));
  return motion;
}

double largest_tip_speed(const TipMotion& motion, double radius) noexcept {
  return (1.0 + kSlabRounding) *
         (length(motion.twist.linear) + swept(length(motion.twist.angular), radius) +
          motion.acceleration * motion.half);
}

double gap_at_least(const PosedPart& base, const PartBox& base_box, const PosedPart& tip,
                    const PartBox& tip_box, double enough) noexcept {
  double gap = least_between(base.sphere_in_world, tip.sphere_in_world);
  if (gap >= enough) return gap;
  gap = std::max(gap, gap_to_box(base, base_box, tip.sphere_in_world));
  if (gap >= enough || !(base.sphere_in_world.radius < kInfinity)) return gap;
  return std::max(gap, gap_to_box(tip, tip_box, base.sphere_in_world));
}

PairAtMiddle query_pair(const PosedPart& base, const PosedPart& tip,
                        TrackingState& tracking) noexcept {
  const RelativePose pose = relative_pose(base.world_from_part, tip.world_from_part);
  DistanceResult found = distance(*base.shape, *tip.shape, pose, tracking, {.depth = false});
  // Only the depth certifies that the bodies overlap.
  if (found.status == DistanceStatus::kDepthNotAsked) {
    found = distance(*base.shape, *tip.shape, pose, tracking);
  }
  const DistanceBounds exact = for_exact_poses(found, base, tip);
  const Mat3& turn = base.world_from_part_rotation;
  PairAtMiddle pair;
  pair.lower = std::isnan(exact.lower) ? -kInfinity : exact.lower;
  pair.upper = std::isnan(exact.upper) ? kInfinity : exact.upper;
  pair.separated = found.status == DistanceStatus::kConverged && exact.lower > 0.0;
  pair.normal = times(turn, found.normal);
  pair.on_base = times(turn, found.point_on_a) + base.world_from_part.position;
  pair.on_tip = times(turn, found.point_on_b) + base.world_from_part.position;
  return pair;
}

PairAtMiddle query_seen(const CloudPairs::Content& content, const PosedPart& base,
                        const PosedPart& tip, SlabBody& slab, CloudTracking& tracking) noexcept {
  const CloudPairs::Answer found = CloudPairs::query(content, base, tip, slab, tracking);
  PairAtMiddle pair;
  pair.lower = -kInfinity;
  pair.upper = kInfinity;
  if (found.status == DistanceStatus::kBadPose) return pair;
  pair.lower = found.bounds.lower;
  pair.upper = found.bounds.upper;
  pair.separated = found.status == DistanceStatus::kConverged && pair.lower > 0.0;
  pair.normal = found.normal;
  pair.on_base = found.witness_a;
  pair.on_tip = found.witness_b;
  return pair;
}

double lower_over(const PairAtMiddle& found, const PosedPart& base, const PosedPart& tip,
                  bool tip_keeps_direction, const TipMotion& motion, const ObjectApproach& approach,
                  double enough) noexcept {
  const double loss = rounded_up(motion.error + approach.nearing.until_end);
  double lower = rounded_down(found.lower - rounded_up(motion.moved + approach.moved + loss));
  if (std::isnan(lower)) return -kInfinity;
  if (lower >= enough || !found.separated || !motion.has_twist) return lower;
  if (!tip_keeps_direction || !base.keeps_direction) return lower;
  if (motion.moved == 0.0 && approach.moved == 0.0) return lower;
  const double bend = rounded_up(0.5 * motion.acceleration * motion.half * motion.half);
  const double more = rounded_up(approach.turned + loss);
  const double slab = by_slab(found, base, tip, motion.twist.linear - approach.velocity,
                              motion.twist.angular, motion.half, bend, enough + more);
  return std::max(lower, rounded_down(slab - more));
}

// The closest points at the middle stay on the bodies, so the distance is never above theirs.
double upper_over(const PairAtMiddle& found, const PosedPart& tip, const TipMotion& motion,
                  const ObjectApproach& approach) noexcept {
  double upper = found.upper + motion.moved + approach.moved + motion.error;
  if (motion.has_twist && found.separated) {
    const Vec3 arm = found.on_tip - tip.sphere_in_world.centre;
    const Vec3 velocity =
        motion.twist.linear + cross(motion.twist.angular, arm) - approach.velocity;
    const Vec3 gap = found.on_tip - found.on_base;
    const double most =
        std::max(length(gap + motion.half * velocity), length(gap - motion.half * velocity));
    const double bend = 0.5 * motion.acceleration * motion.half * motion.half;
    const double sizes = most + length(arm) + length(found.on_tip) + tip.extent;
    upper = std::min(upper, most + (found.upper - found.lower) + bend + motion.error +
                                approach.turned + kSlabRounding * sizes);
  }
  return std::max(0.0, rounded_up(rounded_up(upper) - approach.nearing.until_begin));
}

double closing_speed(const PairAtMiddle& found, const PosedPart& tip, const TipMotion& motion,
                     const ObjectApproach& approach) noexcept {
  if (!motion.has_twist || !found.separated) return 0.0;
  const Vec3 arm = found.on_tip - tip.sphere_in_world.centre;
  return -dot(found.normal,
              motion.twist.linear + cross(motion.twist.angular, arm) - approach.velocity);
}

}  // namespace clearance
