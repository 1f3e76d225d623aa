// The samples of batches with the ids of the scene that is in force, also of batches that were made
// for a scene before it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene_map.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/source_numbers.hpp"

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
  static constexpr std::size_t kFormerScenes = 8;

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
  // for one that is no longer needed.
  void change(std::uint64_t revision, SceneMap& map) noexcept;

  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }
  [[nodiscard]] SourceNumbers& sources() noexcept { return sources_; }
  [[nodiscard]] const SourceNumbers& sources() const noexcept { return sources_; }

 private:
  // A scene before, and how its ids are passed on. When there are more than these, a new one takes
  // the place of the one that has been there longest.
  struct Former {
    std::uint64_t revision = 0;
    SceneMap map = {};
  };
  [[nodiscard]] Former& slot(std::uint64_t revision) noexcept;
  [[nodiscard]] const Former* former(std::uint64_t revision) const noexcept;

  std::uint64_t revision_;
  SourceNumbers sources_;
  std::array<Former, kFormerScenes> former_;
  std::size_t count_ = 0;  // of scenes with another revision, those that are lost included
  bool has_changed_;
};

}  // namespace clearance
