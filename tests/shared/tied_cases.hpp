// Pairs in which several answers are equally right, exactly or but for the last bits: families of
// tests/shared/hard_cases.hpp.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Hulls that have some of their corners in common, to the bit: they touch in a corner, an edge or a
// facet, or share some of their inside.
[[nodiscard]] HardCase shared_corners(Random& random);

// One body within another of the same shape, as deep in many directions, up to a shift of any order
// of magnitude.
[[nodiscard]] HardCase nested(Random& random);

// Prisms and boxes whose every facet is several with normals about 1e-13 apart, facing each other
// level, edge on or flush.
[[nodiscard]] HardCase twin_facets(Random& random);

// Faces through the origin of bodies of up to 1e9 m, and gaps down to the smallest double.
[[nodiscard]] HardCase tiny_gaps(Random& random);

// The same integer body twice, one of them turned by a right angle or half a turn, along a
// diagonal: as close by several pairs of features.
[[nodiscard]] HardCase mirrored(Random& random);

// Boxes without some of their sides, alike in orientation but for up to some ulps or 1e-8 rad:
// walls, bars, columns and floors without end that stand on, beside and in each other.
[[nodiscard]] HardCase open_boxes(Random& random);

}  // namespace clearance::hard
