// The samples of batches with the ids of the scene that is in force, also of batches that were made
// for a scene before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "config/scene/scene_map.hpp"
#include "monitor/inputs/former_scenes.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"
#include "monitor/inputs/state_bytes.hpp"

namespace clearance {

// Gives the samples from `first` on the ids that `now` (SceneMap::objects_now or variables_now) has
// for theirs, and drops those that have none. `input` is the id of a sample.
template <class Sample>
void keep_mapped(std::span<const std::uint32_t> now, std::uint32_t Sample::*input,
                 std::size_t first, std::vector<Sample>& samples) noexcept {
  std::size_t kept = first;
  for (std::size_t i = first; i < samples.size(); ++i) {
    const std::uint32_t before = samples[i].*input;
    if (before >= now.size() || now[before] == SceneMap::kNone) continue;
    samples[kept] = samples[i];
    samples[kept++].*input = now[before];
  }
  samples.resize(kept);
}

// The loop and a replay of its recording both use this, so that they tick the same samples. It does
// not allocate after construction where the capacities of the lists suffice.
class SceneIds {
 public:
  static constexpr std::size_t kFormerScenes = FormerScenes<SceneMap>::kMost;

  // `followed`: this scene followed others, which are not known.
  explicit SceneIds(const Scene& scene, bool followed = false)
      : revision_(scene.revision), sources_(scene), has_changed_(followed) {}

  // Appends the samples of a batch for the scene in force. Those of a batch for one of the last
  // kFormerScenes scenes are passed on where the scene in force has the objects and joints. Returns
  // false, and appends nothing, for a batch of any other revision. After the first change, a batch
  // without a revision (0) is one of these, since it does not say which scene's ids it has.
  [[nodiscard]] bool append(const PoseBatch& batch, std::vector<PoseSample>& poses,
                            std::vector<JointSample>& joints) noexcept;
  // The scene of this revision follows the one in force. `map` is that of the two, and is exchanged
  // for one that is no longer needed. Nothing changes if both are the same scene.
  void change(std::uint64_t revision, SceneMap& map) noexcept;

  // Before the first batch, where scenes followed each other before: passes on the poses of a batch
  // for this former scene. To be called in the order of FormerScenes::for_each. May allocate.
  void restore(std::uint64_t revision, std::vector<std::uint32_t> objects_now) {
    former_.slot(revision).kept.objects_now = std::move(objects_now);
  }

  // Passes the ids of former scenes on, for ids of the same scene elsewhere. May allocate.
  void save_former(StateWriter& out) const;
  void restore_former(StateReader& in, const Scene& scene);

  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
  [[nodiscard]] SourceNumbers& sources() noexcept { return sources_; }
  [[nodiscard]] const SourceNumbers& sources() const noexcept { return sources_; }

 private:
  std::uint64_t revision_;
  SourceNumbers sources_;
  FormerScenes<SceneMap> former_;  // how their ids are passed on
  bool has_changed_;
};

}  // namespace clearance
