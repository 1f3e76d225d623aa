// Part pairs are counted once, when a cell is loaded. If published and other pairs are refreshed
// separately, each kind has a share of its own. Together they need a smaller budget, because the
// share covers the largest pair only once.
#include "config/scene/refresh_share.hpp"

#include <algorithm>

namespace clearance {

void RefreshCost::add(std::uint64_t part_pairs_of_one) noexcept {
  part_pairs += part_pairs_of_one;
  most = std::max(most, part_pairs_of_one);
}

// Each tick takes an equal share of all part pairs, plus the largest pair. A pair is evaluated
// whole, so a tick may exceed its equal share by one pair.
std::uint64_t RefreshCost::queries(std::uint64_t ticks) const noexcept {
  return std::min(part_pairs, part_pairs / ticks + most);
}

RefreshShare refresh_share(const Scene& scene) { return refresh_share(scene, scene.pairs); }

RefreshShare refresh_share(const Scene& scene, std::span<const ObjectPair> pairs) {
  const auto ticks =
      static_cast<std::uint64_t>(std::clamp(scene.refresh_s / scene.longest_period(), 1.0, 1e15));
  RefreshCost published, others, all;
  for (const ObjectPair& pair : pairs) {
    const std::uint64_t part_pairs =
        scene.objects[pair.first].parts.size() * scene.objects[pair.second].parts.size();
    (is_published(pair, scene) ? published : others).add(part_pairs);
    all.add(part_pairs);
  }
  const RefreshShare together{.ticks = ticks, .published = {}, .others = all};
  const RefreshShare apart{
      .ticks = ticks, .published_every_tick = true, .published = published, .others = others};
  if (published.part_pairs > scene.budget) return together;
  const bool only_together = apart.queries() > scene.budget && together.queries() <= scene.budget;
  return only_together ? together : apart;
}

}  // namespace clearance
