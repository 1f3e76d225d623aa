// Finds the pair with the smallest distance. Pairs are evaluated in the order of their lower bounds
// until none left can beat the smallest upper bound. The horizon is raised until no culled pair can
// beat it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/schedule/evaluator.hpp"

namespace clearance {

class MinimumSearch {
 public:
  // `candidates` has capacity for all pairs; between two calls its content may change.
  explicit MinimumSearch(std::vector<std::uint32_t>& candidates) : candidates_(candidates) {}

  // If the budget lasts, no pair that was not updated can be closer than the minimum afterwards.
  void find_minimum(const Evaluator& evaluator) noexcept;

  // The smallest upper bound of the pairs that the last search examined, m.
  [[nodiscard]] double smallest_upper() const noexcept { return smallest_upper_; }

 private:
  void evaluate_closest(const Evaluator& evaluator) noexcept;

  double smallest_upper_ = kInfinity;
  // The horizon rises by this at a time, m. The step doubles, from tick to tick as well, until the
  // horizon has reached the minimum.
  double step_ = Culling::kHeadroom;
  std::vector<std::uint32_t>& candidates_;
};

}  // namespace clearance
