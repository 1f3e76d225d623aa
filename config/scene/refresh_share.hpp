// The share of the budget that refreshing every pair in time takes.
#pragma once

#include <cstdint>

#include "config/scene/scene.hpp"

namespace clearance {

// What it takes to refresh some pairs round-robin, the stalest first.
struct RefreshCost {
  std::uint64_t part_pairs = 0;  // of all pairs: at most this many queries evaluate each pair once
  std::uint64_t most = 0;        // of the pair that has the most

  void add(std::uint64_t part_pairs_of_one) noexcept;
  // Queries a tick that refresh every pair within `ticks`.
  [[nodiscard]] std::uint64_t queries(std::uint64_t ticks) const noexcept;
};

// Queries that refreshing takes in each tick. A cell whose budget is smaller is refused when it is
// loaded.
struct RefreshShare {
  std::uint64_t ticks = 1;  // every pair is refreshed within so many
  // Published pairs are evaluated in every tick in which the budget lasts, apart from all others.
  // If false, they are refreshed together with the others.
  bool published_every_tick = false;
  RefreshCost published;  // empty unless published_every_tick
  RefreshCost others;     // all other pairs

  [[nodiscard]] std::uint64_t queries() const noexcept {
    return published.queries(ticks) + others.queries(ticks);
  }
};

// Published pairs stay apart if all their part pairs fit into the budget of one tick, unless only
// the common round-robin fits. The caller compares queries() with Scene::budget.
[[nodiscard]] RefreshShare refresh_share(const Scene& scene);

// Whether a pair is published: it is then evaluated in every tick as long as the budget allows.
[[nodiscard]] inline bool is_published(const ObjectPair& pair, const Scene& scene) noexcept {
  return pair.publish || scene.evaluate_all;
}

}  // namespace clearance
