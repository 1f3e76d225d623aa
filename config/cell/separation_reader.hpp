// Reads `separation:` of a zone: the terms of ISO/TS 15066's protective separation distance.
#pragma once

#include <optional>

#include "config/cell/group_index.hpp"
#include "config/scene/scene.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// Reports objects that are on both sides. `zone` has its pairs, as indices into `pairs`.
[[nodiscard]] Separation read_separation(const YamlNode& node, const Between& between,
                                         const Zone& zone, const std::vector<ObjectPair>& pairs,
                                         const ObjectList& objects, const Quantities& quantities);

}  // namespace clearance
