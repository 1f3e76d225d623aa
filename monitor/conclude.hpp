// Stage 7 of a tick: zones, minimum and the reports of published pairs, from the pairs that it has
// looked at and what holds of the rest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "monitor/broad_phase/culling.hpp"
#include "monitor/pairs/global_minimum.hpp"
#include "monitor/schedule/scheduler.hpp"
#include "monitor/swept/zone_crossings.hpp"
#include "monitor/zones/zones.hpp"

namespace clearance {

struct Conclusion {
  GlobalMinimum minimum;        // over all pairs that are known
  std::uint32_t evaluated = 0;  // pairs
};

// The pairs that every report names.
struct Published {
  std::vector<std::uint32_t> pairs;        // in ascending order
  std::vector<std::uint8_t> is_published;  // by pair
};

// One pair as of this tick, seen or not, with what the sweep has told about it. `precision`: how
// closely the time since the last tick is looked at.
[[nodiscard]] PairBounds bounds_in_tick(std::uint32_t pair, SweptPrecision precision,
                                        const ZoneCrossings& crossings,
                                        const Evaluation& evaluation) noexcept;

// Writes all of a pair's report.
void write_pair(std::uint32_t pair, const PairBounds& bounds, const Scheduler& scheduler,
                const Culling& culling, const Evaluation& evaluation, PairReport& report) noexcept;

// Also takes the zones to this tick. `reports`: of the published pairs, in their order.
void conclude(const Published& published, const Displacements& displaced, const Culling& culling,
              const Scheduler& scheduler, const ZoneLevels& levels, const ZoneCrossings& crossings,
              const Evaluation& evaluation, Zones& zones, Conclusion& conclusion,
              std::span<PairReport> reports) noexcept;

}  // namespace clearance
