// Chooses the pairs that reports carry, where the rules of a cell leave it open.
#pragma once

#include <span>
#include <string>

#include "config/cell/pair_reader.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

// The objects of the pairs, and what places them.
struct PlacedObjects {
  std::span<const Object> objects;
  std::span<const Robot> robots;
  std::span<const JointVariable> variables;
};

// Publishes pairs of `pairs.open` until a report is full. Pairs of zones come first, then those
// that are nearest with all joints at zero, or at the nearest limit; a pair whose place is not
// known counts as near. Returns a note about those that stay unpublished; empty: there are none.
[[nodiscard]] std::string publish_open_pairs(const PlacedObjects& placed,
                                             std::span<const Zone> zones, PairList& pairs);

}  // namespace clearance
