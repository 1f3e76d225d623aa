// How often the inputs of a log come, beside how old they may be.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/inputs/pose_batch.hpp"

namespace clearance {

// Of one source.
class InputRate {
 public:
  // Every batch in its order.
  void note(const Scene& scene, const PoseBatch& batch);

  // When most of them come later than the age limit after the one before: a sentence with both, and
  // the limit that would fit. `source`: as it reads there.
  void add_note(const std::string& source, std::vector<std::string>& notes) const;

 private:
  std::int64_t stamp_ns_ = -1;  // of the last batch
  std::int64_t limit_ns_ = 0;   // the smallest of what it moves
  std::uint64_t intervals_ = 0, too_long_ = 0;
  std::int64_t sum_ns_ = 0;  // of the intervals
};

}  // namespace clearance
