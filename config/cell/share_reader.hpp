// Reads `shares:`, which divides the pairs of a cell among several daemons.
#pragma once

#include <string>
#include <vector>

#include "config/cell/group_index.hpp"
#include "config/cell/pair_reader.hpp"
#include "config/cell/shares.hpp"
#include "config/yaml/diagnostics.hpp"

namespace clearance {

// `pairs` and `zones` are those of the whole cell. Reports shares that have a pair in common, pairs
// that no share has, and shares without a pair. Returns nothing after a mistake.
[[nodiscard]] std::vector<Share> read_shares(const YamlNode& node,
                                             const std::vector<Object>& objects,
                                             const std::vector<ObjectPair>& pairs,
                                             const std::vector<Zone>& zones,
                                             GroupIndex& group_index, Diagnostics& diagnostics);

}  // namespace clearance
