// Is some pair of the zone too near? With hysteresis, on what is certain: lower bounds less
// margins.
#pragma once

#include <vector>

#include "monitor/pair_summary.hpp"

namespace clearance {

// Takes the zone's report from the last tick to this one. Active when some pair's clearance is
// below enter_below; no longer when every pair's is above leave_above.
void update(const Scene& scene, const Zone& zone, const std::vector<PairSummary>& pairs,
            std::uint64_t cycle, ZoneReport& report) noexcept;

}  // namespace clearance
