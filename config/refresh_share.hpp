// The share of the budget that refreshing every pair in time takes.
#pragma once

#include <cstdint>

#include "config/scene.hpp"

namespace clearance {

// What refreshing some pairs round-robin takes, the stalest first.
struct RefreshCost {
  std::uint64_t part_pairs = 0;  // of all: queries that evaluating each pair once takes at most
  std::uint64_t most = 0;        // of the pair that has the most

  void add(std::uint64_t part_pairs_of_one) noexcept;
  // Queries a tick that refresh every pair within `ticks`.
  [[nodiscard]] std::uint64_t queries(std::uint64_t ticks) const noexcept;
};

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

[[nodiscard]] RefreshShare refresh_share(const Scene& scene);

// Such a pair is evaluated in every tick as long as the budget allows.
[[nodiscard]] inline bool is_published(const ObjectPair& pair, const Scene& scene) noexcept {
  return pair.publish || scene.evaluate_all;
}

}  // namespace clearance
