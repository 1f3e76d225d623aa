// Stages 'judge' and 'conclude' of a tick: contacts, zones, minimum and the reports of published
// pairs. It uses the pairs that the tick has updated, and the bounds that hold for all others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/pairs/global_minimum.hpp"
#include "monitor/schedule/culling.hpp"
#include "monitor/schedule/zone_crossings.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {

struct Conclusion {
  GlobalMinimum minimum;        // over all pairs that are known
  std::uint32_t evaluated = 0;  // number of pairs
};

// The pairs that every report names.
struct Published {
  std::vector<std::uint32_t> pairs;        // in ascending order
  std::vector<std::uint8_t> is_published;  // by pair
};

// The bounds of one pair in this tick, updated or not, with the results of the sweep. `precision`
// says how closely the time since the last tick is examined.
[[nodiscard]] PairBounds bounds_in_tick(std::uint32_t pair, SweptPrecision precision,
                                        const ZoneCrossings& crossings,
                                        const TickView& view) noexcept;

// Decides for every pair with a contact whether that is as allowed.
void judge(const TickView& view, const ZoneCrossings& crossings, Contacts& contacts) noexcept;

// Concludes the tick, and advances the zones to it. `reports` are those of the published pairs, in
// their order.
[[nodiscard]] Conclusion conclude(const Published& published, const Displacements& displaced,
                                  const Culling& culling, const ZoneCrossings& crossings,
                                  const TickView& view, Zones& zones,
                                  std::span<PairReport> reports) noexcept;

}  // namespace clearance
