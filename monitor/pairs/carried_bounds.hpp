// Carries a pair's bounds from the tick in which they were found to the poses of this tick.
#pragma once

#include <cstdint>

#include "monitor/pairs/tick_view.hpp"

namespace clearance {

// No point of the two objects has come farther since the pair was brought up to date, both
// objects together, m.
[[nodiscard]] double displacement_since(std::uint32_t pair, const TickView& view) noexcept;

// True when raise() has brought the pair's bounds to this tick although an object of the pair has
// moved since the last tick.
[[nodiscard]] bool raised_this_tick(std::uint32_t pair, const TickView& view) noexcept;

// The pair's distance at the last tick was at least this, m, if its objects were known then.
[[nodiscard]] double lower_last_tick(std::uint32_t pair, const TickView& view) noexcept;

// A part pair's bounds for the poses in use, when both objects have a pose. The bounds as they were
// last brought up to date are widened by `displacement`, m. They are never looser than those by the
// parts' spheres and by the direction that last separated the parts.
[[nodiscard]] DistanceBounds bounds_now(std::uint32_t part_pair, double displacement,
                                        const TickView& view) noexcept;

// Brings a pair's part pairs up to date. Both objects are known.
void carry(std::uint32_t pair, const OpenTick& tick) noexcept;

// Records that a pair's part pairs are up to date. It must be called before `least_lower` is
// replaced, because the bound for the last tick is computed from the old value.
void note_carried(std::uint32_t pair, const OpenTick& tick) noexcept;

// Takes in a lower bound of the pair's distance for the poses in use, m. The part pairs are carried
// by displacement alone, which costs a fraction of carry(): the caller has tried coarser models.
void raise(std::uint32_t pair, double to, const OpenTick& tick) noexcept;

}  // namespace clearance
