// Makes reports whole that carry only the pairs that changed (`publish: changes`).
#pragma once

#include <cstdint>
#include <vector>

#include "clearance.h"

namespace clearance::client {

class CompleteReports {
 public:
  // Completes a message: the pairs that it leaves out are as in the messages before. If one of
  // those is missing, they are unknown until the next full report. Returns false then. Afterwards
  // changes_since is 0. Messages come in the order of their cycles.
  bool complete(clearance_msg_Distances& message);

 private:
  std::uint64_t cycle_ = 0, sender_ = 0, revision_ = 0;  // of the message before
  bool is_known_ = false;
  std::vector<clearance_msg_PairDistance> pairs_;
};

// The report of a pair about which nothing is known.
[[nodiscard]] clearance_msg_PairDistance unknown_pair(std::uint32_t pair) noexcept;

}  // namespace clearance::client
