// Steps of a tick that must leave something of its budget.
#pragma once

#include <algorithm>
#include <cstdint>

#include "monitor/pairs/evaluate_pair.hpp"

namespace clearance {

// Takes a step with so many queries fewer.
template <class Step>
inline void sparing(std::uint32_t queries, Evaluation& evaluation, const Step& step) noexcept {
  const std::uint32_t spared = std::min(queries, evaluation.queries_left);
  evaluation.queries_left -= spared;
  step();
  evaluation.queries_left += spared;
}

}  // namespace clearance
