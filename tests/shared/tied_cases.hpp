// Pairs in which several answers are equally right, exactly or up to the last bits: families of
// tests/shared/hard_cases.hpp.
#pragma once

#include "tests/shared/hard_cases.hpp"

namespace clearance::hard {

// Hulls that share some vertices exactly. They touch in a vertex, an edge or a facet, or their
// interiors overlap.
[[nodiscard]] HardCase shared_corners(Random& random);

// A body within another of the same shape, with the same depth in many directions, up to a
// translation of any order of magnitude.
[[nodiscard]] HardCase nested(Random& random);

// Prisms and boxes on which several rows replace each facet. The normals of these rows differ by
// about 1e-13 rad. The bodies face each other level, edge on or flush.
[[nodiscard]] HardCase twin_facets(Random& random);

// Bodies of up to 1e9 m with faces through the origin, and gaps down to the smallest double.
[[nodiscard]] HardCase tiny_gaps(Random& random);

// The same integer body twice, one of them rotated by a right angle or half a turn and moved along
// a diagonal. Several pairs of features are equally close.
[[nodiscard]] HardCase mirrored(Random& random);

// Boxes without some of their sides, with equal orientations up to some ulps or 1e-8 rad. They are
// unbounded walls, bars, columns and floors that stand on, beside and in each other.
[[nodiscard]] HardCase open_boxes(Random& random);

}  // namespace clearance::hard
