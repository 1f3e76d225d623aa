// Evaluates pairs and books that: what all steps of the schedule do with the pairs they choose.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/broad_phase/culling.hpp"
#include "monitor/pairs/evaluate_pairs.hpp"
#include "monitor/schedule/refresh_queue.hpp"

namespace clearance {

struct Evaluator {
  Evaluation& tick;
  Culling& culling;
  RefreshQueue& queue;
  WorkerPool& pool;

  // Known pairs that are not evaluated yet, as many of the first as the budget covers.
  void evaluate(std::span<const std::uint32_t> pairs) const noexcept {
    const std::size_t done = clearance::evaluate(pairs, pool, tick);
    for (const std::uint32_t pair : pairs.first(done)) {
      culling.see(pair);
      const bool queued = is_evaluated(pair, tick) && !culling.broad_phase().left_out(pair);
      if (queued) queue.refreshed(pair, tick.cycle);
    }
  }
  // False: the budget did not cover it.
  [[nodiscard]] bool evaluate(std::uint32_t pair) const noexcept {
    evaluate(std::span(&pair, 1));
    return is_evaluated(pair, tick);
  }
  // Takes note of what the last step of the culling has decided.
  void take_decided() const noexcept {
    for (const Culling::Decided& decided : culling.decided()) {
      if (decided.proved_far) {
        queue.refreshed(decided.pair, tick.cycle);
      } else {
        queue.enter(decided.pair);
      }
    }
  }
};

}  // namespace clearance
