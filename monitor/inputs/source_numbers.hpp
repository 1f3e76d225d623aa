// Numbers for the names of sources, as PoseSample::source has them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// Whose poses or joints the cell asks for, each once, in its order. The reader of cells refuses
// more than there are places.
[[nodiscard]] std::vector<SourceName> named_sources(const Scene& scene);

// The sources that the cell names come first, in its order; the others follow as they are first
// heard. One beyond kMaxSources takes the number of the one, not named by the cell, that was heard
// longest ago. Whoever asks for the same sources in the same order gets the same numbers.
class SourceNumbers {
 public:
  explicit SourceNumbers(const Scene& scene);
  [[nodiscard]] std::uint32_t of(const SourceName& source) noexcept;
  // Empty: no source has that number.
  [[nodiscard]] SourceName name(std::uint32_t number) const noexcept;

 private:
  struct Place {
    SourceName source;
    std::uint64_t last_use = 0;  // 0: never
  };
  std::array<Place, kMaxSources> places_;
  std::size_t named_ = 0;
  std::uint64_t uses_ = 0;
};

}  // namespace clearance
