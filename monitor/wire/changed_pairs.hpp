// Reports that carry only the pairs that changed, so that their bytes follow motion.
// client/complete_reports.hpp makes them whole again.
#pragma once

#include <cstdint>
#include <vector>

#include "clearance.h"

namespace clearance {

// A pair is left out while everything that it says of the bodies is bit for bit as it was listed
// last, and no pose is older than it was then by more than this. Cycles and smaller differences of
// ages do not count.
inline constexpr std::int64_t kUnlistedAge = 10'000'000;  // ns

class ChangedPairs {
 public:
  // Every report whose cycle is a multiple of `full_every` has all pairs; 0: every report.
  explicit ChangedPairs(std::uint64_t full_every) : full_every_(full_every) {}
  // False: it leaves all messages as they are.
  [[nodiscard]] bool reduces() const noexcept { return full_every_ != 0; }

  // Leaves out the pairs of `message` that are as in the message before, and states so: a full one
  // has its own cycle as changes_since. All messages are of one scene. The first one of a lineage
  // is full.
  void reduce(clearance_msg_Distances& message);

 private:
  std::uint64_t full_every_;
  std::uint64_t cycle_ = 0, lineage_ = 0;           // of the message before
  std::vector<clearance_msg_PairDistance> listed_;  // as listed last
};

}  // namespace clearance
