// The exact depth of two overlapping bodies, found by trying every candidate direction.
//
// The shortest translation that separates two convex bodies is normal to a facet of either, or to
// an edge of each (separating axis theorem; S. Gottschalk, M. Lin, D. Manocha, "OBBTree", 1996).
// Along any other direction the translation is longer, so additional directions do no harm. All
// rows therefore count as facets. For bodies given by points, all triples and pairs of points count
// as facets and edges (see exact_features.hpp). Doubles exclude the directions that are far from
// optimal; rationals decide the rest.
#pragma once

#include <optional>

#include "core/pose.hpp"
#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

// The square of the depth of the bodies without their radii; 0 if they only touch or are disjoint.
// Empty if no translation separates them.
[[nodiscard]] std::optional<Rational> exact_squared_depth(const Body& a, const Pose& world_from_a,
                                                          const Body& b, const Pose& world_from_b);

}  // namespace clearance::oracle
