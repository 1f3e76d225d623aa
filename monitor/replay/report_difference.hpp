// Finds the first difference between two reports of the same tick.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/replay/comparison.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// The first field that differs, with both values, e.g. "pairs[2] (hand - box).lower: recorded 0.5,
// replayed 0.25"; none when they agree. When and whether a report was published is no part of a
// tick. Cycle numbers in `recorded` may be ahead of those in `replayed` by `cycle_offset`.
[[nodiscard]] std::optional<std::string> report_difference(const Scene& scene,
                                                           const clearance_msg_Distances& recorded,
                                                           const clearance_msg_Distances& replayed,
                                                           std::uint64_t cycle_offset,
                                                           Comparison comparison);

}  // namespace clearance
