// The minimum over all pairs, and whether it is certified, from the pairs worth a look and what
// is known of the rest.
#pragma once

#include <cstdint>

#include "monitor/pairs/pair_bounds.hpp"

namespace clearance {

class GlobalMinimum {
 public:
  // In any number, also the same pair again.
  void add(std::uint32_t pair, const PairBounds& bounds) noexcept;

  // Every pair that was not added is at least this far apart, m; and has been since the last tick.
  void add_rest(double lower, double swept_lower) noexcept;

  // The added pair with the smallest upper bound, of those that have ever been evaluated.
  [[nodiscard]] bool known() const noexcept { return known_; }
  [[nodiscard]] std::uint32_t pair() const noexcept { return pair_; }
  [[nodiscard]] const PairBounds& bounds() const noexcept { return bounds_; }  // of pair()

  // No other pair can be closer: beyond what rounding leaves open between two that were both
  // evaluated.
  [[nodiscard]] bool certified() const noexcept;

  // Every pair's distance is at least this, m.
  [[nodiscard]] double lower() const noexcept { return lower_; }
  // And has been since the last tick, m.
  [[nodiscard]] double swept_lower() const noexcept { return swept_lower_; }

 private:
  bool known_ = false;
  std::uint32_t pair_ = 0;
  PairBounds bounds_;  // of pair_
  double lower_ = kInfinity, swept_lower_ = kInfinity, rest_lower_ = kInfinity;
  // Of the pairs whose distance is not known to rounding, the two with the smallest lower bounds.
  std::uint32_t loose_pair_ = 0;
  double loose_lower_ = kInfinity, next_loose_lower_ = kInfinity;
};

}  // namespace clearance
