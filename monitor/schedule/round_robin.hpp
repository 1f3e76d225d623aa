// Round-robin refresh: the bound of every pair is found afresh in time, whatever else is urgent.
//
// The stalest pairs come first, culled or not. A pair is refreshed by the models of its objects
// where these prove it far, else by an evaluation. Published pairs that the budget does not cover
// in one tick are evaluated round-robin as well. The queries for both are kept from urgent pairs
// (RefreshBudget).
#pragma once

#include <cstdint>

#include "config/scene/refresh_share.hpp"
#include "monitor/pairs/published_pairs.hpp"
#include "monitor/schedule/evaluator.hpp"
#include "monitor/schedule/refresh_budget.hpp"

namespace clearance {

class RoundRobin {
 public:
  RoundRobin(const Scene& scene, const RefreshShare& share);

  // Adds one tick's share to the queries that are due.
  void begin_tick() noexcept;
  // Queries to keep for the published pairs that are due, and for the others.
  [[nodiscard]] std::uint32_t kept_for_published() const noexcept { return published_.kept(); }
  [[nodiscard]] std::uint32_t kept_for_others() const noexcept { return others_.kept(); }

  // Brings the pairs of objects that are known again back into the queue.
  void bring_back(const Culling& culling, const TickView& view) noexcept;

  // `all_published`: all published pairs that are known have been evaluated in this tick.
  void refresh(const PublishedPairs& published, bool all_published,
               const Evaluator& evaluator) noexcept;

  [[nodiscard]] RefreshQueue& queue() noexcept { return queue_; }
  [[nodiscard]] const RefreshQueue& queue() const noexcept { return queue_; }

 private:
  void evaluate_published(const PublishedPairs& published, const Evaluator& evaluator) noexcept;
  void refresh_stalest(const Evaluator& evaluator) noexcept;
  [[nodiscard]] bool refresh_pair(std::uint32_t pair, const Evaluator& evaluator) noexcept;
  void set_aside(std::uint32_t pair, const TickView& view) noexcept;

  const std::uint64_t ticks_;  // within which every pair is refreshed
  RefreshBudget published_, others_;
  const std::uint32_t per_tick_;    // pairs to be refreshed in each tick
  RefreshQueue queue_;              // of the pairs that are not left out of the broad phase
  std::size_t next_published_ = 0;  // the published pair whose turn it is
};

}  // namespace clearance
