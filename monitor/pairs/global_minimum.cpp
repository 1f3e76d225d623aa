#include "monitor/pairs/global_minimum.hpp"

#include <algorithm>

#include "monitor/interface/tight_bounds.hpp"

namespace clearance {

void GlobalMinimum::add(std::uint32_t pair, const PairBounds& bounds, double stated) noexcept {
  lower_ = std::min(lower_, bounds.lower);
  swept_lower_ = std::min(swept_lower_, bounds.swept_lower);
  if (!is_known(bounds.status)) return;

  const bool tight = is_evaluated(bounds.status) && are_tight(bounds.lower, bounds.upper - stated);
  if (!tight && bounds.lower < loose_lower_) {
    if (pair != loose_pair_) next_loose_lower_ = loose_lower_;
    loose_lower_ = bounds.lower;
    loose_pair_ = pair;
  } else if (!tight && pair != loose_pair_) {
    next_loose_lower_ = std::min(next_loose_lower_, bounds.lower);
  }

  if (bounds.evaluated_cycle == 0) return;
  const bool closer =
      !known_ || bounds.upper < bounds_.upper ||
      (bounds.upper == bounds_.upper &&
       (bounds.lower < bounds_.lower || (bounds.lower == bounds_.lower && pair < pair_)));
  if (!closer) return;
  known_ = true;
  pair_ = pair;
  bounds_ = bounds;
}

void GlobalMinimum::add_rest(double lower, double swept_lower) noexcept {
  lower_ = std::min(lower_, lower);
  swept_lower_ = std::min(swept_lower_, swept_lower);
  rest_lower_ = std::min(rest_lower_, lower);
}

bool GlobalMinimum::certified() const noexcept {
  if (!known_ || rest_lower_ < bounds_.upper) return false;
  const double loose = loose_pair_ == pair_ ? next_loose_lower_ : loose_lower_;
  return loose >= bounds_.upper;
}

}  // namespace clearance
