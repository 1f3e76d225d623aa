// The exact depth of two overlapping bodies, by trying every direction that can be the one.
//
// The shortest translation that parts two convex bodies is along the normal of a facet of either,
// or across an edge of each (S. Gottschalk, M. Lin, D. Manocha, "OBBTree", 1996, for the separating
// axis theorem). Along any other direction it is longer, so more directions do no harm: all rows
// count as facets, and of bodies given by points all triples and pairs (see exact_features.hpp).
// Doubles decide which directions are out of the question by far; rationals do the rest.
#pragma once

#include <optional>

#include "core/pose.hpp"
#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

// The square of the depth of the bodies without their radii; 0 if they only touch or are apart.
// Nothing if no translation parts them.
[[nodiscard]] std::optional<Rational> exact_squared_depth(const Body& a, const Pose& world_from_a,
                                                          const Body& b, const Pose& world_from_b);

}  // namespace clearance::oracle
