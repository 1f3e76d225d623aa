// Round-robin refresh: every pair has its bound found afresh in time, whatever else is urgent.
//
// The stalest pairs first, culled or not: by the models of their objects where these prove them out
// of question, else by an evaluation. Published pairs that the budget does not cover in one tick
// are evaluated round-robin as well. What that takes is kept from what is urgent (RefreshBudget).
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

  // What is due grows by a tick's share.
  void begin_tick() noexcept;
  // Queries to keep for what is due of the published pairs, and of the others.
  [[nodiscard]] std::uint32_t kept_for_published() const noexcept { return published_.kept(); }
  [[nodiscard]] std::uint32_t kept_for_others() const noexcept { return others_.kept(); }

  // Pairs that some object's return has made known come back into the queue.
  void bring_back(const Culling& culling, const Evaluation& evaluation) noexcept;

  // `all_published`: all published pairs that are known have been evaluated in this tick.
  void refresh(const PublishedPairs& published, bool all_published,
               const Evaluator& evaluator) noexcept;

  [[nodiscard]] RefreshQueue& queue() noexcept { return queue_; }
  [[nodiscard]] const RefreshQueue& queue() const noexcept { return queue_; }

 private:
  void evaluate_published(const PublishedPairs& published, const Evaluator& evaluator) noexcept;
  void refresh_stalest(const Evaluator& evaluator) noexcept;
  [[nodiscard]] bool refresh(std::uint32_t pair, const Evaluator& evaluator) noexcept;
  void set_aside(std::uint32_t pair, const Evaluation& evaluation) noexcept;

  const std::uint64_t ticks_;  // within which every pair is refreshed
  RefreshBudget published_, others_;
  const std::uint32_t per_tick_;    // pairs to be refreshed a tick
  RefreshQueue queue_;              // of the pairs that the broad phase is told of
  std::size_t next_published_ = 0;  // whose turn it is
};

}  // namespace clearance
