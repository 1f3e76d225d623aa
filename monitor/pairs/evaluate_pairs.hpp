// Many pairs at once, shared between workers.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/pairs/worker_pool.hpp"

namespace clearance {

// Evaluates different pairs, none of them evaluated in this tick yet, in their order as far as the
// budget goes; returns how many that are. Which queries are made, and what comes out, is the same
// for any number of workers.
std::size_t evaluate(std::span<const std::uint32_t> pairs, WorkerPool& pool,
                     Evaluation& evaluation) noexcept;

}  // namespace clearance
