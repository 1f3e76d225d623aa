// How many queries of a tick are kept for the round-robin refresh, so that every pair is refreshed
// in time.
//
// Each tick owes (part pairs + 1) / ticks of a query; what a whole number of them has come to is
// due. A refresh that may spend due + most - 1 queries, `most` being what one pair can take, spends
// what is due or refreshes all. So over any `ticks` ticks at least `part_pairs` are spent, and
// every pair is refreshed. The count is in whole numbers, so that nothing drifts.
#pragma once

#include <algorithm>
#include <cstdint>

#include "config/scene/refresh_share.hpp"

namespace clearance {

class RefreshBudget {
 public:
  // Keeps nothing back of a budget that is too small for it.
  RefreshBudget(const RefreshCost& pairs, std::uint64_t ticks, bool affordable) noexcept
      : part_pairs_(affordable ? pairs.part_pairs : 0), most_(pairs.most), ticks_(ticks) {}

  void begin_tick() noexcept { owed_ += part_pairs_ == 0 ? 0 : part_pairs_ + 1; }
  // In this tick, of the queries that pairs take at most.
  [[nodiscard]] std::uint32_t due() const noexcept {
    return static_cast<std::uint32_t>(owed_ / ticks_);
  }
  [[nodiscard]] std::uint32_t kept() const noexcept {
    return due() == 0 ? 0 : static_cast<std::uint32_t>(std::min(part_pairs_, due() + most_ - 1));
  }
  // Every pair will find enough kept for it when its refresh is due.
  [[nodiscard]] bool is_sure() const noexcept { return part_pairs_ > 0; }
  // Ends the tick: pairs that take `spent` queries at most have been refreshed, or all have.
  void end_tick(std::uint32_t spent) noexcept {
    if (spent > due()) return all_refreshed();
    owed_ %= ticks_;
  }
  void all_refreshed() noexcept { owed_ = 0; }

 private:
  const std::uint64_t part_pairs_, most_, ticks_;
  std::uint64_t owed_ = 0;  // in parts of a query, `ticks` to the whole
};

}  // namespace clearance
