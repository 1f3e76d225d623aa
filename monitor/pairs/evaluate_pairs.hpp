// Evaluates many pairs, shared between workers.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/pairs/worker_pool.hpp"

namespace clearance {

// Evaluates different pairs in their order, as far as the budget goes; returns how many. None of
// them was evaluated in this tick before. The queries and their results are the same for any number
// of workers.
std::size_t evaluate_pairs(std::span<const std::uint32_t> pairs, WorkerPool& pool,
                           const OpenTick& tick, Budget& budget) noexcept;

}  // namespace clearance
