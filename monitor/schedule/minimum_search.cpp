// The part of triage that finds the minimum: the horizon, and the search in order of lower bounds.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "monitor/schedule/scheduler.hpp"

namespace clearance {
namespace {

// How far the horizon is kept above the minimum: the farther, the more pairs are awake, the less
// often one has to be woken when the minimum grows. m.
constexpr double kHeadroom = 0.02;
// The horizon follows a growing minimum by no more than this a tick while it is above it, m.
constexpr double kHorizonStep = 0.002;
constexpr int kMostRaises = 8;  // a tick

}  // namespace

// The horizon stays a little above the minimum of the last tick. What no translation parts
// (-infinity) moves it nowhere: every minimum is below it.
void Scheduler::follow_minimum() noexcept {
  if (!std::isfinite(smallest_upper_)) return;
  const double horizon = broad_phase_.horizon();
  const double best = smallest_upper_ + kHeadroom;
  if (!(horizon > -kInfinity) || best < horizon - kHeadroom) {
    broad_phase_.move_horizon(best);
  } else if (best > horizon + 0.5 * kHeadroom) {
    broad_phase_.move_horizon(std::min(best, horizon + kHorizonStep));
  }
}

// The first one: the minimum of the pairs seen so far is not beyond it.
void Scheduler::find_horizon() noexcept {
  if (broad_phase_.horizon() > -kInfinity) return;
  double smallest_upper = kInfinity;
  for (const std::uint32_t pair : broad_phase_.woken()) {
    smallest_upper = std::min(smallest_upper, broad_phase_.by_balls(pair).upper);
  }
  if (smallest_upper < kInfinity) broad_phase_.move_horizon(smallest_upper + kHeadroom);
}

// When the budget lasts, no pair that sleeps can be closer than the minimum afterwards.
void Scheduler::evaluate_minimum(Evaluation& evaluation) noexcept {
  evaluate_closest(evaluation);
  double step = kHeadroom;
  for (int i = 0; i < kMostRaises; ++i, step *= 2.0) {
    const double horizon = broad_phase_.horizon();
    const bool all_current = current_.size() == counts_.known();
    if (all_current || smallest_upper_ <= horizon || !(horizon > -kInfinity)) return;
    if (evaluation.queries_left == 0 || broad_phase_.pending()) return;
    broad_phase_.move_horizon(std::min(smallest_upper_ + kHeadroom, horizon + step));
    settle_woken(evaluation);
    evaluate_closest(evaluation);
  }
}

// In batches that grow: one is mostly enough, and what is shared between workers must not depend on
// how many they are.
void Scheduler::evaluate_closest(Evaluation& evaluation) noexcept {
  const PairTable& table = evaluation.table;
  const auto upper_of = [&table](std::uint32_t pair) {
    const PairEntry& entry = table.entries[pair];
    double upper = table.upper[entry.first_row];
    for (std::uint32_t row = entry.first_row + 1; row < entry.end_row; ++row) {
      upper = std::min(upper, table.upper[row]);
    }
    return upper;
  };
  double smallest_upper = kInfinity;
  scratch_.clear();
  for (const std::uint32_t pair : current_) {
    smallest_upper = std::min(smallest_upper, upper_of(pair));
    if (!is_evaluated(pair, evaluation)) scratch_.push_back(pair);
  }
  std::erase_if(scratch_, [&](std::uint32_t pair) {
    return !(table.entries[pair].least_lower < smallest_upper);
  });
  const auto later = [&table](std::uint32_t left, std::uint32_t right) {
    return std::tie(table.entries[left].least_lower, left) >
           std::tie(table.entries[right].least_lower, right);
  };
  std::make_heap(scratch_.begin(), scratch_.end(), later);
  auto end = scratch_.end();
  for (std::ptrdiff_t size = 1; evaluation.queries_left > 0; size *= 2) {
    auto first = end;
    while (first != scratch_.begin() && end - first < size &&
           table.entries[scratch_.front()].least_lower < smallest_upper) {
      std::pop_heap(scratch_.begin(), first--, later);
    }
    if (first == end) break;
    std::reverse(first, end);
    evaluate_these({first, end}, evaluation);
    for (auto it = first; it != end; ++it) {
      smallest_upper = std::min(smallest_upper, upper_of(*it));
    }
    end = first;
  }
  smallest_upper_ = smallest_upper;
}

}  // namespace clearance
