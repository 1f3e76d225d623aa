// The minimum over all pairs, and whether it is certified, from the pairs that a tick has updated
// and what is known of all others.
#pragma once

#include <cstdint>

#include "monitor/pairs/pair_bounds.hpp"

namespace clearance {

class GlobalMinimum {
 public:
  // Takes in a pair; the same pair may come again. `stated`: the part of the width of its bounds
  // that stated errors make, m. No work could take that away.
  void add(std::uint32_t pair, const PairBounds& bounds, double stated = 0.0) noexcept;

  // The distance of every pair that was not added is at least `lower`, m, and since the last tick
  // it was at least `swept_lower`.
  void add_rest(double lower, double swept_lower) noexcept;

  // The pair with the smallest upper bound, among the added pairs that have ever been evaluated.
  [[nodiscard]] bool known() const noexcept { return known_; }
  [[nodiscard]] std::uint32_t pair() const noexcept { return pair_; }
  [[nodiscard]] const PairBounds& bounds() const noexcept { return bounds_; }  // of pair()

  // True if no other added pair can be closer. A pair that was evaluated in this tick with tight
  // bounds may be closer by kTightGap at most. The bounds of pair() itself may be wide.
  [[nodiscard]] bool certified() const noexcept;

  // A lower bound of every pair's distance, m.
  [[nodiscard]] double lower() const noexcept { return lower_; }
  // The same for every instant since the last tick, m.
  [[nodiscard]] double swept_lower() const noexcept { return swept_lower_; }

 private:
  bool known_ = false;
  std::uint32_t pair_ = 0;
  PairBounds bounds_;  // of pair_
  double lower_ = kInfinity, swept_lower_ = kInfinity, rest_lower_ = kInfinity;
  // The two smallest lower bounds among the pairs whose distance is not known to rounding.
  std::uint32_t loose_pair_ = 0;
  double loose_lower_ = kInfinity, next_loose_lower_ = kInfinity;
};

}  // namespace clearance
