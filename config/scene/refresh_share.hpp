// The share of the budget that refreshes every pair in time.
#pragma once

#include <cstdint>
#include <span>

#include "config/scene/scene.hpp"

namespace clearance {

// The cost of refreshing some pairs round-robin, the stalest first.
struct RefreshCost {
  std::uint64_t part_pairs = 0;  // sum over the pairs: queries that evaluate each once, at most
  std::uint64_t most = 0;        // part pairs of the largest pair

  void add(std::uint64_t part_pairs_of_one) noexcept;
  // Returns the queries a tick that refresh every pair within `ticks`.
  [[nodiscard]] std::uint64_t queries(std::uint64_t ticks) const noexcept;
};

// The queries of each tick that refresh pairs. A cell whose budget is smaller is refused when it is
// loaded.
struct RefreshShare {
  std::uint64_t ticks = 1;  // every pair is refreshed within so many
  // Published pairs are evaluated separately from all others, in every tick whose budget lasts. If
  // false, they are refreshed together with the others.
  bool published_every_tick = false;
  RefreshCost published;  // empty unless published_every_tick
  RefreshCost others;     // all other pairs

  [[nodiscard]] std::uint64_t queries() const noexcept {
    return published.queries(ticks) + others.queries(ticks);
  }
};

// If all part pairs of the published pairs fit into the budget of one tick, published pairs are
// kept separate. The exception is a budget that is enough only for one common round-robin. The
// caller compares queries() with Scene::budget.
[[nodiscard]] RefreshShare refresh_share(const Scene& scene);
// The same for some pairs of the scene's objects.
[[nodiscard]] RefreshShare refresh_share(const Scene& scene, std::span<const ObjectPair> pairs);

// Tells whether a pair is published: it is then evaluated in every tick as long as the budget
// lasts.
[[nodiscard]] inline bool is_published(const ObjectPair& pair, const Scene& scene) noexcept {
  return pair.publish || scene.evaluate_all;
}

}  // namespace clearance
