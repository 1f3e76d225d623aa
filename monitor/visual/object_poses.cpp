#include "monitor/visual/object_poses.hpp"

#include <algorithm>
#include <span>

namespace clearance {
namespace {

// Of a source: more than a reader of the poses topic keeps.
constexpr std::size_t kMostWaiting = 64;
// A source that has sent nothing of an object for this long gives it to another (idl/README.md).
constexpr std::int64_t kSourceLeftNs = 1'000'000'000;

Pose pose_of(const clearance_msg_ObjectPose& wire) {
  const auto& p = wire.position;
  const auto& q = wire.orientation;
  return {Vec3(p.x, p.y, p.z), Eigen::Quaterniond(q.w, q.x, q.y, q.z)};
}

bool is_usable(const Pose& pose) {
  return pose.position.allFinite() && std::abs(pose.orientation.squaredNorm() - 1.0) < 1e-2;
}

}  // namespace

ObjectPoses::ObjectPoses(const Scene& scene) : scene_(scene), objects_(scene.objects.size()) {
  forget();
}

void ObjectPoses::forget() {
  waiting_.clear();
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    objects_[i] = {};
    if (scene_.objects[i].fixed) objects_[i].pose = scene_.objects[i].world_from_object;
  }
}

void ObjectPoses::take(const clearance_msg_PoseBatch& batch) {
  if (batch.scene_revision != 0 && batch.scene_revision != scene_.revision) return;
  Batch taken{batch.sequence_number, 0, {}};
  for (const auto& wire : std::span(batch.poses._buffer, batch.poses._length)) {
    taken.stamp_ns = std::max(taken.stamp_ns, wire.stamp_ns);
    if (wire.object >= objects_.size() || scene_.objects[wire.object].fixed) continue;
    const Pose pose = pose_of(wire);
    if (is_usable(pose)) taken.poses.push_back({wire.object, wire.stamp_ns, pose});
  }
  auto& queue = waiting_[batch.source];
  queue.push_back(std::move(taken));
  if (queue.size() <= kMostWaiting) return;
  apply(batch.source, queue.front());
  queue.pop_front();
}

bool ObjectPoses::use(const clearance_msg_Distances& report) {
  moved_ = false;
  const std::int64_t newest_ns = report.newest_pose_ns + report.clock_offset_ns;
  for (const auto& [source, queue] : waiting_) apply_up_to(0, newest_ns, source);
  for (const auto& used : std::span(report.sources._buffer, report.sources._length)) {
    apply_up_to(used.sequence_number, newest_ns, used.source);
  }
  return moved_;
}

// Batches of a source from the front on, as long as one of the two says that they have been used.
void ObjectPoses::apply_up_to(std::uint64_t sequence_number, std::int64_t stamp_ns,
                              const std::string& source) {
  const auto found = waiting_.find(source);
  if (found == waiting_.end()) return;
  auto& queue = found->second;
  while (!queue.empty() &&
         (queue.front().sequence_number <= sequence_number || queue.front().stamp_ns <= stamp_ns)) {
    apply(source, queue.front());
    queue.pop_front();
  }
}

void ObjectPoses::apply(const std::string& source, const Batch& batch) {
  for (const Moved& moved : batch.poses) {
    Known& known = objects_[moved.object];
    const std::string& named = scene_.objects[moved.object].source;
    if (!named.empty() && named != source) continue;
    const bool other = known.pose && known.source != source;
    if (other && moved.stamp_ns - known.stamp_ns < kSourceLeftNs) continue;
    known = {moved.pose, moved.stamp_ns, source};
    moved_ = true;
  }
}

}  // namespace clearance
