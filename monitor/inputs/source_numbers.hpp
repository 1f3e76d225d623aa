// Numbers for the names of sources, as stored in PoseSample::source.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// The sources that the cell names for its poses and joints, each once, in the order of the cell.
// The reader of cells refuses more than kMaxSources.
[[nodiscard]] std::vector<SourceName> named_sources(const Scene& scene);

// The sources that the cell names come first, in its order. The others follow in the order in which
// they are first heard, or are named by a changed scene. When all kMaxSources numbers are taken, a
// new source replaces the source that was heard longest ago and that the cell does not name. The
// same requests in the same order give the same numbers.
class SourceNumbers {
 public:
  explicit SourceNumbers(const Scene& scene);
  // kNoSource: the cell names kMaxSources other sources.
  [[nodiscard]] std::uint32_t of(const SourceName& source) noexcept;
  // The scene was changed: the sources that it names keep their numbers from now on, too. Returns
  // false, and numbers none, if there are more than kMaxSources named ones now.
  bool add_named(std::span<const SourceName> sources) noexcept;
  // Appends the samples of a batch with the number of their sender. A sender NAME#2 is the second
  // writer of NAME: the number of NAME is set as well, if the cell names that. Does not allocate
  // where the capacities suffice.
  void append(const PoseBatch& batch, std::vector<PoseSample>& poses,
              std::vector<JointSample>& joints);
  // `own`: before anything was heard.
  [[nodiscard]] bool is_sound(const SourceNumbers& own) const noexcept;
  // Returns an empty name when no source has that number.
  [[nodiscard]] SourceName name(std::uint32_t number) const noexcept;

 private:
  struct Place {
    SourceName source;
    std::uint64_t last_use = 0;  // 0: never
    bool is_named = false;       // by the cell
  };
  [[nodiscard]] const Place* find(const SourceName& source) const noexcept;
  // The number of NAME for its writers NAME#2, NAME#3 and so on, if the cell names NAME. The suffix
  // may have left no space for the beginning of a long name.
  [[nodiscard]] std::uint32_t namesake_of(const SourceName& source) const noexcept;
  [[nodiscard]] std::uint32_t index(const Place& place) const noexcept {
    return static_cast<std::uint32_t>(&place - places_.data());
  }

  std::array<Place, kMaxSources> places_;
  std::uint64_t uses_ = 0;
};

}  // namespace clearance
