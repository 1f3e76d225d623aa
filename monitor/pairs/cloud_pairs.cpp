#include "monitor/pairs/cloud_pairs.hpp"

#include <algorithm>
#include <utility>

#include "monitor/bodies/bounding_sphere.hpp"
#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/interface/tight_bounds.hpp"

namespace clearance {
namespace {

// `excess` is no width that more work would take away.
DistanceStatus status_of(const NearestElement& found, double excess) noexcept {
  if (!found.within_work_limit) return DistanceStatus::kIterationLimit;
  if (found.upper < 0.0) return DistanceStatus::kOverlapping;
  if (found.lower <= 0.0) return DistanceStatus::kTouching;
  return are_tight(found.lower, found.upper - excess) ? DistanceStatus::kConverged
                                                      : DistanceStatus::kIterationLimit;
}

}  // namespace

CloudPairs::CloudPairs(const Scene& scene, const std::vector<PosedPart>& parts,
                       const PairTable& table)
    : content_(scene.sensors.size()), slot_(table.part_pairs(), kNone) {
  for (const Object& object : scene.objects) sensor_of_.push_back(object.sensor);
  for (std::uint32_t part_pair = 0; part_pair < table.part_pairs(); ++part_pair) {
    const bool is_of_sensor = scene.objects[parts[table.part_a(part_pair)].object].is_seen() ||
                              scene.objects[parts[table.part_b(part_pair)].object].is_seen();
    if (!is_of_sensor) continue;
    slot_[part_pair] = static_cast<std::uint32_t>(tracking_.size());
    tracking_.emplace_back();
  }
}

CloudPairs::Answer CloudPairs::query(std::uint32_t part_pair, const PosedPart& a,
                                     const PosedPart& b) noexcept {
  const bool a_is_cloud = sensor_of_[a.object] != Object::kNoSensor;
  const PosedPart& seen = a_is_cloud ? a : b;
  Answer answer = query(content_[sensor_of_[seen.object]], seen, a_is_cloud ? b : a, body_,
                        tracking_[slot_[part_pair]], work_left_ / kShareOfAQuery);
  work_left_ -= std::min(work_left_, answer.overlap_work);
  if (a_is_cloud) return answer;
  std::swap(answer.witness_a, answer.witness_b);
  answer.normal = -answer.normal;
  return answer;
}

CloudPairs::Answer CloudPairs::query(const Content& content, const PosedPart& seen,
                                     const PosedPart& part, SlabBody& body, CloudTracking& tracking,
                                     std::uint32_t most_overlap_work) noexcept {
  Answer answer;
  answer.witness_a = answer.witness_b = answer.normal = Vec3::Constant(kNan);
  if (content.cloud == nullptr) return answer;
  const NearestElement found =
      content.cloud->nearest(*part.shape, relative_pose(part.world_from_part, seen.world_from_part),
                             body, tracking, most_overlap_work, part.object);
  answer.overlap_work = found.overlap_work;
  if (found.answer == CloudAnswer::kBadPose) return answer;
  const double error = rounded_up(placing_error(seen, part) + content.pose_error);
  if (found.answer == CloudAnswer::kEmpty) {
    answer.bounds = {rounded_down(std::min(found.lower, content.range) - error),
                     most_between(seen.sphere_in_world, part.sphere_in_world)};
    answer.status = DistanceStatus::kIterationLimit;
    return answer;
  }
  answer.bounds = {rounded_down(found.lower - error), rounded_up(found.upper + error)};
  answer.status = status_of(found, content.cloud->excess());
  const Mat3& turn = part.world_from_part_rotation;
  answer.witness_a = turn * found.point_on_element + part.world_from_part.position;
  answer.witness_b = turn * found.point_on_part + part.world_from_part.position;
  answer.normal = -(turn * found.normal);
  return answer;
}

}  // namespace clearance
