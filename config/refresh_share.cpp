#include "config/refresh_share.hpp"

#include <algorithm>

namespace clearance {

void TakingTurns::add(std::uint64_t rows_of_one) noexcept {
  rows += rows_of_one;
  most = std::max(most, rows_of_one);
}

std::uint64_t TakingTurns::queries(std::uint64_t ticks) const noexcept {
  return std::min(rows, rows / ticks + most);
}

RefreshShare refresh_share(const Scene& scene) {
  const auto ticks =
      static_cast<std::uint64_t>(std::clamp(scene.refresh_s * scene.rate_hz, 1.0, 1e15));
  TakingTurns asked, others, all;
  for (const ObjectPair& pair : scene.pairs) {
    const std::uint64_t rows =
        scene.objects[pair.first].parts.size() * scene.objects[pair.second].parts.size();
    (is_asked(pair, scene) ? asked : others).add(rows);
    all.add(rows);
  }
  const RefreshShare together{.ticks = ticks, .asked = {}, .others = all};
  const RefreshShare apart{
      .ticks = ticks, .asked_every_tick = true, .asked = asked, .others = others};
  if (asked.rows > scene.budget) return together;
  const bool only_together = apart.queries() > scene.budget && together.queries() <= scene.budget;
  return only_together ? together : apart;
}

}  // namespace clearance
