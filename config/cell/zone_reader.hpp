// Reads `zones:`: named thresholds on the distance between two groups.
#pragma once

#include <vector>

#include "config/cell/pair_reader.hpp"
#include "config/scene/scene.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// Reports a zone that covers a pair which is neither watched nor allowed to touch: the zone would
// promise too much. Pairs of zones with `separation` become published ones.
[[nodiscard]] std::vector<Zone> read_zones(const YamlNode& node, const ObjectList& objects,
                                           GroupIndex& group_index, const Quantities& quantities,
                                           PairList& pairs);

}  // namespace clearance
