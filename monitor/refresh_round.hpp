// The round in which every pair has its turn to be evaluated, whether anything moves or not.
//
// Remembers, in at most 2^16 figures, when the pairs had their last turn, so that the stalest is
// known without looking.
#pragma once

#include <cstdint>
#include <vector>

#include "monitor/object_state.hpp"

namespace clearance {

class RefreshRound {
 public:
  RefreshRound(std::size_t objects, std::size_t pairs);

  // The pair whose turn it is, in tick `cycle`; the next call gives the next one. There are pairs.
  std::uint32_t take_turn(std::uint64_t cycle) noexcept;

  // Takes note of whom the turns of late have passed over, since they were not known.
  void look(const std::vector<ObjectState>& objects) noexcept;

  // No pair that is known had its last turn before this tick; 0: some had none yet.
  [[nodiscard]] std::uint64_t oldest_turn() const noexcept;

 private:
  const std::size_t pairs_;
  const std::size_t block_;                // pairs of one figure
  std::vector<std::uint64_t> entered_;     // by block: when its first pair had its last turn
  std::vector<std::uint64_t> lost_sight_;  // by object: oldest_turn() when it was last known
  std::vector<std::uint8_t> known_;        // by object, at the last look
  std::size_t next_ = 0;
  std::uint64_t block_before_ = 0;     // what entered_ was of the block that next_ is in
  std::uint64_t oldest_regained_ = 0;  // of pairs that are known again, while turns_missed_ > 0
  std::size_t turns_missed_ = 0;       // until these have had one again
};

}  // namespace clearance
