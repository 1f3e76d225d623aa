// Reads `separation:` of a zone: the terms of ISO/TS 15066's protective separation distance.
#pragma once

#include <optional>

#include "config/cell/pair_reader.hpp"
#include "config/scene/scene.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// Reports objects that are on both sides, and pairs of a person and what moves that are allowed to
// touch. `zone` has its pairs, as indices into `list`.
[[nodiscard]] Separation read_separation(const YamlNode& node, const Between& between,
                                         const Zone& zone, const PairList& list,
                                         const ObjectList& objects, const Quantities& quantities);

}  // namespace clearance
