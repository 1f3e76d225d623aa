#include "tools/merge/zone_check.hpp"

#include <algorithm>
#include <span>

#include "monitor/interface/report.hpp"

namespace clearance::merge {

ZoneCheck::ZoneCheck(const Cell& cell)
    : cell_(cell), was_doubtful_(cell.scene.zones.size()), was_unheard_(cell.scene.zones.size()) {}

void ZoneCheck::check(const client::SharedCell& whole) {
  const Scene& scene = cell_.scene;
  if (whole->scene_revision != scene.revision) return;
  const std::span pairs(whole->pairs._buffer, whole->pairs._length);
  for (const auto& [id, state] : whole.zones()) {
    if (id >= scene.zones.size()) continue;
    const Zone& zone = scene.zones[id];
    const bool is_unheard =
        state.active && state.cause == static_cast<std::uint8_t>(ZoneCause::kNoShare);
    if (is_unheard && !was_unheard_[id]) ++unheard_;
    was_unheard_[id] = is_unheard;
    const bool is_inside = std::ranges::any_of(zone.pairs, [&](std::uint32_t pair) {
      const auto at = std::ranges::lower_bound(pairs, pair, {}, &clearance_msg_PairDistance::pair);
      if (at == pairs.end() || at->pair != pair) return false;
      const ObjectPair& of = scene.pairs[pair];
      const double margins = scene.objects[of.first].margin + scene.objects[of.second].margin;
      return at->swept_lower - margins < zone.enter_below;
    });
    const bool is_doubtful = is_inside && !state.active;
    if (is_doubtful && was_doubtful_[id]) ++wrong_;
    was_doubtful_[id] = is_doubtful;
  }
}

}  // namespace clearance::merge
