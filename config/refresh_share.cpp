#include "config/refresh_share.hpp"

#include <algorithm>

namespace clearance {

void TakingTurns::add(std::uint64_t rows_of_one) noexcept {
  rows += rows_of_one;
  most = std::max(most, rows_of_one);
}

std::uint64_t TakingTurns::queries(std::uint64_t ticks) const noexcept {
  return rows == 0 ? 0 : rows / ticks + most;
}

RefreshShare refresh_share(const Scene& scene) {
  RefreshShare share;
  share.ticks = static_cast<std::uint64_t>(std::clamp(scene.refresh_s * scene.rate_hz, 1.0, 1e15));
  TakingTurns all;
  for (const ObjectPair& pair : scene.pairs) {
    const std::uint64_t rows =
        scene.objects[pair.first].parts.size() * scene.objects[pair.second].parts.size();
    (is_asked(pair, scene) ? share.asked : share.others).add(rows);
    all.add(rows);
  }
  // Those that do not fit take their turns like all others.
  if (share.asked.rows > scene.budget) share = {.ticks = share.ticks, .asked = {}, .others = all};
  return share;
}

}  // namespace clearance
