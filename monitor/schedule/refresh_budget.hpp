// The number of queries of a tick that are kept for the round-robin refresh, so that every pair is
// refreshed in time.
//
// Each tick adds (part_pairs + 1) / ticks queries to the debt. The integer part of the debt is due.
// Let `most` be the largest number of queries that one pair can take. A refresh that may spend due
// + most - 1 queries spends all that are due, or refreshes all pairs. So over any `ticks` ticks at
// least `part_pairs` queries are spent, and every pair is refreshed. The count is in integers, so
// that it does not drift.
#pragma once

#include <algorithm>
#include <cstdint>

#include "config/scene/refresh_share.hpp"

namespace clearance {

class RefreshBudget {
 public:
  // If the refresh is not affordable, nothing is kept for it.
  RefreshBudget(const RefreshCost& pairs, std::uint64_t ticks, bool affordable) noexcept
      : part_pairs_(affordable ? pairs.part_pairs : 0), most_(pairs.most), ticks_(ticks) {}

  void begin_tick() noexcept { owed_ += part_pairs_ == 0 ? 0 : part_pairs_ + 1; }
  // The number of queries that are due in this tick. A pair counts with the largest number that it
  // can take.
  [[nodiscard]] std::uint32_t due() const noexcept {
    return static_cast<std::uint32_t>(owed_ / ticks_);
  }
  [[nodiscard]] std::uint32_t kept() const noexcept {
    return due() == 0 ? 0 : static_cast<std::uint32_t>(std::min(part_pairs_, due() + most_ - 1));
  }
  // Enough queries will be kept for every pair when its refresh is due.
  [[nodiscard]] bool is_sure() const noexcept { return part_pairs_ > 0; }
  // Ends the tick: pairs that take `spent` queries at most have been refreshed.
  void end_tick(std::uint32_t spent) noexcept {
    if (spent > due()) return all_refreshed();
    owed_ %= ticks_;
  }
  void all_refreshed() noexcept { owed_ = 0; }

 private:
  const std::uint64_t part_pairs_, most_, ticks_;
  std::uint64_t owed_ = 0;  // in units of 1 / ticks of a query
};

}  // namespace clearance
