// What refreshing every pair in time takes of the budget.
#pragma once

#include <cstdint>

#include "config/scene.hpp"

namespace clearance {

// Pairs that take turns, the stalest first.
struct TakingTurns {
  std::uint64_t rows = 0;  // queries that evaluating each once takes, at most: its pairs of parts
  std::uint64_t most = 0;  // and of the one that takes the most

  void add(std::uint64_t rows_of_one) noexcept;
  // Queries that a tick must be able to spend on them so that each has its turn within so many.
  [[nodiscard]] std::uint64_t queries(std::uint64_t ticks) const noexcept;
};

struct RefreshShare {
  std::uint64_t ticks = 1;        // within which every pair is to be refreshed
  bool asked_every_tick = false;  // those that somebody asks for are evaluated in every tick in
                                  // which the budget lasts, apart from all others: else with them
  TakingTurns asked;              // these, if so
  TakingTurns others;             // all other pairs

  [[nodiscard]] std::uint64_t queries() const noexcept {
    return asked.queries(ticks) + others.queries(ticks);
  }
};

[[nodiscard]] RefreshShare refresh_share(const Scene& scene);

// Evaluated in every tick as long as the budget allows.
[[nodiscard]] inline bool is_asked(const ObjectPair& pair, const Scene& scene) noexcept {
  return pair.publish || scene.evaluate_all;
}

}  // namespace clearance
