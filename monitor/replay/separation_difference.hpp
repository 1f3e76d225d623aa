// Finds the first difference between what a tick said of zones with `separation`, recorded and
// replayed.
#pragma once

#include <optional>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/wire/dds_sample.hpp"

namespace clearance {

// The first field that differs, to the bit, with both values: "zone 'people', hand - box, scaling:
// recorded 0.5, replayed 0.25"; none when they agree. Pairs that were left out of the recording
// are not compared.
[[nodiscard]] std::optional<std::string> separation_difference(
    const Scene& scene, const clearance_msg_Separation& recorded,
    const clearance_msg_Separation& replayed);

}  // namespace clearance
