// Poses as they travel: one sample of one source, with what it takes to find it again in a
// recording.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "monitor/pose_batch.hpp"

namespace clearance {

inline constexpr std::size_t kMaxSources = 16;       // as in idl/clearance.idl
inline constexpr std::size_t kMaxSourceLength = 32;  // characters

// Who sent a batch. Fixed size: copied in the tick thread.
class SourceName {
 public:
  SourceName() = default;
  // Longer names are cut.
  explicit SourceName(std::string_view text) noexcept {
    text.substr(0, kMaxSourceLength).copy(text_.data(), kMaxSourceLength);
  }
  [[nodiscard]] const char* c_str() const noexcept { return text_.data(); }
  [[nodiscard]] std::string_view view() const noexcept { return text_.data(); }
  bool operator==(const SourceName&) const = default;

 private:
  std::array<char, kMaxSourceLength + 1> text_{};  // the rest is zeros
};

// One sample of the topic `poses`.
struct PoseBatch {
  SourceName source;
  std::uint64_t sequence_number = 0;
  std::uint64_t scene_revision = 0;  // of the catalogue its ids are from; 0: not said
  std::vector<PoseSample> samples;
};

// Whether the ids of a batch are those of this scene; revision 0 says nothing and is taken.
[[nodiscard]] inline bool made_for(const PoseBatch& batch, std::uint64_t scene_revision) noexcept {
  return batch.scene_revision == 0 || batch.scene_revision == scene_revision;
}

// The last batch of a source that a tick took in.
struct SourceUse {
  SourceName source;
  std::uint64_t sequence_number = 0;
};

}  // namespace clearance
