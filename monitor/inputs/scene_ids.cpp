#include "monitor/inputs/scene_ids.hpp"

#include <algorithm>
#include <utility>

namespace clearance {
namespace {

// `ids` lead to ids of the scene before the last change, and lead to those of the changed one then.
void pass_on(std::span<const std::uint32_t> now, std::vector<std::uint32_t>& ids) noexcept {
  for (std::uint32_t& id : ids) id = id < now.size() ? now[id] : SceneMap::kNone;
}

bool lead_to(std::size_t count, std::span<const std::uint32_t> ids) noexcept {
  return std::ranges::all_of(ids,
                             [=](std::uint32_t id) { return id < count || id == SceneMap::kNone; });
}

}  // namespace

bool SceneIds::append(const PoseBatch& batch, std::vector<PoseSample>& poses,
                      std::vector<JointSample>& joints) noexcept {
  const bool in_force =
      batch.scene_revision == 0 ? !has_changed_ : batch.scene_revision == revision_;
  const auto* const before = in_force ? nullptr : former_.find(batch.scene_revision);
  if (!in_force && before == nullptr) return false;
  const std::size_t first_pose = poses.size(), first_joint = joints.size();
  if (!batch.empty()) sources_.append(batch, poses, joints);
  if (before == nullptr) return true;
  keep_mapped(before->kept.objects_now, &PoseSample::object, first_pose, poses);
  keep_mapped(before->kept.variables_now, &JointSample::variable, first_joint, joints);
  return true;
}

void SceneIds::save_former(StateWriter& out) const {
  out.put(has_changed_);
  out.put(former_.size());
  former_.for_each([&out](const auto& scene) {
    out.put(scene.revision);
    out.put(std::span(scene.kept.objects_now));
    out.put(std::span(scene.kept.variables_now));
  });
}

void SceneIds::restore_former(StateReader& in, const Scene& scene) {
  constexpr std::size_t kMostIds = 1 << 20;
  std::size_t scenes = 0;
  in.take(has_changed_);
  in.expect(are_flags(has_changed_));
  in.take(scenes);
  in.expect(scenes <= kFormerScenes);
  former_.clear();
  for (std::size_t i = 0; in.good() && i < scenes; ++i) {
    std::uint64_t revision = 0;
    in.take(revision);
    auto& kept = former_.slot(revision).kept;
    in.take_list(kept.objects_now, kMostIds);
    in.take_list(kept.variables_now, kMostIds);
    in.expect(lead_to(scene.objects.size(), kept.objects_now) &&
              lead_to(scene.variables.size(), kept.variables_now));
  }
}

// The ids of all former scenes are passed on to those of the changed one.
void SceneIds::change(std::uint64_t revision, SceneMap& map) noexcept {
  if (revision == revision_) return;
  auto& last = former_.slot(revision_);
  revision_ = revision;
  std::swap(last.kept, map);
  has_changed_ = true;
  former_.for_each([&last](auto& scene) {
    if (&scene == &last) return;
    pass_on(last.kept.objects_now, scene.kept.objects_now);
    pass_on(last.kept.variables_now, scene.kept.variables_now);
  });
}

}  // namespace clearance
