#include "monitor/pairs/global_minimum.hpp"

#include <algorithm>

namespace clearance {

void GlobalMinimum::add(std::uint32_t pair, const PairBounds& summary) noexcept {
  lower_ = std::min(lower_, summary.lower);
  lower_since_ = std::min(lower_since_, summary.swept_lower);
  if (summary.status == PairStatus::kUnknown) return;

  const bool tight = is_evaluated(summary.status) && summary.status != PairStatus::kLoose;
  if (!tight && summary.lower < loose_lower_) {
    if (pair != loose_pair_) next_loose_lower_ = loose_lower_;
    loose_lower_ = summary.lower;
    loose_pair_ = pair;
  } else if (!tight && pair != loose_pair_) {
    next_loose_lower_ = std::min(next_loose_lower_, summary.lower);
  }

  if (summary.evaluated_cycle == 0) return;
  const bool closer =
      !known_ || summary.upper < summary_.upper ||
      (summary.upper == summary_.upper &&
       (summary.lower < summary_.lower || (summary.lower == summary_.lower && pair < pair_)));
  if (!closer) return;
  known_ = true;
  pair_ = pair;
  summary_ = summary;
}

void GlobalMinimum::add_rest(double lower, double swept_lower) noexcept {
  lower_ = std::min(lower_, lower);
  lower_since_ = std::min(lower_since_, swept_lower);
  rest_lower_ = std::min(rest_lower_, lower);
}

bool GlobalMinimum::proved() const noexcept {
  if (!known_ || rest_lower_ < summary_.upper) return false;
  const double loose = loose_pair_ == pair_ ? next_loose_lower_ : loose_lower_;
  return loose >= summary_.upper;
}

}  // namespace clearance
