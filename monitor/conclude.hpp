// Stage 7 of a tick: zones and minimum, from the pairs that it has looked at and what holds of the
// rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/broad_phase/culling.hpp"
#include "monitor/pairs/global_minimum.hpp"
#include "monitor/swept/zone_crossings.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {

struct Conclusion {
  std::vector<PairBounds> published;  // as in the list of published pairs
  GlobalMinimum minimum;              // over all pairs that are known
  std::uint32_t evaluated = 0;        // pairs
};

// One pair as of this tick, seen or not, with what the sweep has told about it. `precision`: how
// closely the time since the last tick is looked at.
[[nodiscard]] PairBounds bounds_in_tick(std::uint32_t pair, SweptPrecision precision,
                                        const ZoneCrossings& crossings,
                                        const Evaluation& evaluation) noexcept;

// Also takes the zones to this tick. `published`: those pairs, in ascending order; `is_published`:
// by pair.
void conclude(std::span<const std::uint32_t> published, std::span<const std::uint8_t> is_published,
              const Displacements& displaced, const Culling& culling, const ZoneLevels& levels,
              const ZoneCrossings& crossings, const Evaluation& evaluation, Zones& zones,
              Conclusion& conclusion) noexcept;

}  // namespace clearance
