// Evaluates pairs and records that: every step of the schedule works through it.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/schedule/culling.hpp"
#include "monitor/schedule/refresh_queue.hpp"

namespace clearance {

struct Evaluator {
  const OpenTick& tick;
  Budget& budget;
  Culling& culling;
  RefreshQueue& queue;

  // Evaluates as many of the first pairs as the budget covers. All are known, and none was
  // evaluated in this tick before.
  void evaluate_affordable(std::span<const std::uint32_t> pairs) const noexcept {
    const std::size_t done = evaluate_pairs(pairs, tick, budget);
    for (const std::uint32_t pair : pairs.first(done)) {
      culling.mark_updated(pair);
      if (is_evaluated(pair, tick)) note_refreshed(pair);
    }
  }
  // Evaluates one pair; false: the budget did not cover it.
  [[nodiscard]] bool try_evaluate(std::uint32_t pair) const noexcept {
    evaluate_affordable(std::span(&pair, 1));
    return is_evaluated(pair, tick);
  }
  // Records that a pair's bound was found afresh in this tick.
  void note_refreshed(std::uint32_t pair) const noexcept {
    tick.table.entries[pair].refreshed_cycle = tick.cycle;
    if (!culling.broad_phase().left_out(pair)) queue.move_to_back(pair);
  }
  // Queues the pairs that the last step of the culling has decided about.
  void queue_decided() const noexcept {
    constexpr std::size_t kAhead = 8;
    const auto all = culling.decided();
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (i + 2 * kAhead < all.size()) {
        queue.fetch(all[i + 2 * kAhead].pair);
        __builtin_prefetch(&tick.table.entries[all[i + 2 * kAhead].pair].refreshed_cycle, 1);
      }
      if (i + kAhead < all.size()) queue.fetch_neighbours(all[i + kAhead].pair);
      const Culling::Decided& decided = all[i];
      if (decided.proved_far) {
        note_refreshed(decided.pair);
      } else {
        queue.enter(decided.pair, tick.pairs);
      }
    }
  }
};

}  // namespace clearance
