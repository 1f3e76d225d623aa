#include "monitor/schedule/minimum_search.hpp"

#include <algorithm>
#include <tuple>

namespace clearance {
namespace {

constexpr int kMostRaises = 8;            // of the horizon in one tick
constexpr double kLargestRaise = 1000.0;  // m: wider than cells are

}  // namespace

void MinimumSearch::find_minimum(const Evaluator& evaluator) noexcept {
  evaluate_closest(evaluator);
  for (int i = 0; !evaluator.culling.covers(smallest_upper_); ++i) {
    if (i == kMostRaises || evaluator.budget.left() == 0) return;
    if (evaluator.culling.broad_phase().any_waits()) return;
    evaluator.culling.raise_horizon(smallest_upper_, step_, evaluator.tick, evaluator.budget);
    step_ = std::min(2.0 * step_, kLargestRaise);
    evaluator.queue_decided();
    evaluate_closest(evaluator);
  }
  step_ = Culling::kHeadroom;
}

// Evaluates in batches that grow, because one pair is mostly enough.
void MinimumSearch::evaluate_closest(const Evaluator& evaluator) noexcept {
  const PairTable& table = evaluator.tick.pairs;
  double smallest_upper = kInfinity;
  candidates_.clear();
  for (const std::uint32_t pair : evaluator.culling.updated()) {
    smallest_upper = std::min(smallest_upper, upper_of(pair, table));
    if (!is_evaluated(pair, evaluator.tick)) candidates_.push_back(pair);
  }
  std::erase_if(candidates_, [&](std::uint32_t pair) {
    return !(table.entries[pair].least_lower < smallest_upper);
  });
  const auto later = [&table](std::uint32_t left, std::uint32_t right) {
    return std::tie(table.entries[left].least_lower, left) >
           std::tie(table.entries[right].least_lower, right);
  };
  std::make_heap(candidates_.begin(), candidates_.end(), later);
  auto end = candidates_.end();
  for (std::ptrdiff_t size = 1; evaluator.budget.left() > 0; size *= 2) {
    auto first = end;
    while (first != candidates_.begin() && end - first < size &&
           table.entries[candidates_.front()].least_lower < smallest_upper) {
      std::pop_heap(candidates_.begin(), first--, later);
    }
    if (first == end) break;
    std::reverse(first, end);
    evaluator.evaluate_affordable({first, end});
    for (auto it = first; it != end; ++it) {
      smallest_upper = std::min(smallest_upper, upper_of(*it, table));
    }
    end = first;
  }
  smallest_upper_ = smallest_upper;
}

}  // namespace clearance
