#include "monitor/inputs/scene_ids.hpp"

#include <algorithm>
#include <utility>

namespace clearance {
namespace {

// `ids` lead to ids of the scene before the last change, and lead to those of the changed one then.
void pass_on(std::span<const std::uint32_t> now, std::vector<std::uint32_t>& ids) noexcept {
  for (std::uint32_t& id : ids) id = id < now.size() ? now[id] : SceneMap::kNone;
}

}  // namespace

bool SceneIds::append(const PoseBatch& batch, std::vector<PoseSample>& poses,
                      std::vector<JointSample>& joints) noexcept {
  const bool in_force =
      batch.scene_revision == 0 ? !has_changed_ : batch.scene_revision == revision_;
  const Former* const before = in_force ? nullptr : former(batch.scene_revision);
  if (!in_force && before == nullptr) return false;
  if (batch.empty()) return true;
  const std::size_t first_pose = poses.size(), first_joint = joints.size();
  sources_.append(batch, poses, joints);
  if (before == nullptr) return true;
  keep_mapped(before->map.objects_now, &PoseSample::object, first_pose, poses);
  keep_mapped(before->map.variables_now, &JointSample::variable, first_joint, joints);
  return true;
}

// The ids of all former scenes are passed on to those of the changed one.
void SceneIds::change(std::uint64_t revision, SceneMap& map) noexcept {
  Former& last = slot(revision_);
  last.revision = std::exchange(revision_, revision);
  std::swap(last.map, map);
  has_changed_ = true;
  for (Former& scene : former_) {
    if (&scene == &last) continue;
    pass_on(last.map.objects_now, scene.map.objects_now);
    pass_on(last.map.variables_now, scene.map.variables_now);
  }
}

// A scene that was in force before keeps its place, so that attaching and detaching again and again
// does not displace the scene whose ids senders have.
SceneIds::Former& SceneIds::slot(std::uint64_t revision) noexcept {
  for (std::size_t i = 0; i < std::min(count_, kFormerScenes); ++i) {
    if (former_[i].revision == revision) return former_[i];
  }
  return former_[count_++ % kFormerScenes];
}

const SceneIds::Former* SceneIds::former(std::uint64_t revision) const noexcept {
  for (std::size_t i = 0; i < std::min(count_, kFormerScenes); ++i) {
    if (former_[i].revision == revision) return &former_[i];
  }
  return nullptr;
}

}  // namespace clearance
