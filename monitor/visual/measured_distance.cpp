#include "monitor/visual/measured_distance.hpp"

#include <algorithm>
#include <span>

#include "core/distance.hpp"
#include "monitor/bodies/bounding_sphere.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/pairs/pair_bounds.hpp"

namespace clearance {
namespace {

// The distance of two parts in `nearest`, if it is less than what is there. No stated error changes
// it by more than `model_error`, m.
void take_nearer(const PosedPart& a, const PosedPart& b, double model_error,
                 MeasuredDistance& nearest) {
  TrackingState cold;
  const DistanceResult found =
      distance(*a.shape, *b.shape, relative_pose(a.world_from_part, b.world_from_part), cold);
  const DistanceBounds exact = widened(for_exact_poses(found, a, b), model_error);
  nearest.lower = std::min(nearest.lower, exact.lower);
  if (!(exact.upper < nearest.upper)) return;
  nearest.upper = exact.upper;
  nearest.distance = found.distance;
  nearest.status = status_of(found.status);
  const Mat3& turn = a.world_from_part_rotation;
  nearest.witness_a = turn * found.point_on_a + a.world_from_part.position;
  nearest.witness_b = turn * found.point_on_b + a.world_from_part.position;
}

}  // namespace

// Two parts whose spheres are farther apart than others can be do not decide.
MeasuredDistance MeasuredDistances::between(std::uint32_t a, std::uint32_t b,
                                            const ObjectPoses& poses) {
  const std::size_t objects = first_.size() - 1;
  if (a == b || a >= objects || b >= objects) return {};
  if (scene_.objects[a].is_seen() || scene_.objects[b].is_seen()) return {};
  if (!poses.is_on_time(a) || !poses.is_on_time(b)) return {};
  const auto placed = [&](std::uint32_t object) {
    const std::span<PosedPart> parts(parts_.data() + first_[object],
                                     first_[object + 1] - first_[object]);
    for (PosedPart& part : parts) place_at(*poses.pose(object), part);
    return parts;
  };
  const auto parts_a = placed(a), parts_b = placed(b);
  MeasuredDistance nearest;
  nearest.lower = kInfinity;
  for (const PosedPart& part_a : parts_a) {
    for (const PosedPart& part_b : parts_b) {
      if (least_between(part_a.sphere_in_world, part_b.sphere_in_world) > nearest.upper) continue;
      take_nearer(part_a, part_b, errors_.largest(a, b), nearest);
    }
  }
  if (nearest.status == PairStatus::kUnknown) return {};
  nearest.distance = std::clamp(nearest.distance, nearest.lower, nearest.upper);
  return nearest;
}

}  // namespace clearance
