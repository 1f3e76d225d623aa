// The directions in which an exact body may have facets and edges.
#pragma once

#include <vector>

#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

// Directions in the body's local frame, of any length. The lists may contain repetitions and
// directions that belong to no feature. A normal points outwards.
struct Features {
  std::vector<RationalVec> normals, edges;
};

[[nodiscard]] Features features_of(const Body& body);

// Returns true if the number of features is proportional to the number of rows or points. The rows
// or points must show that the body is a prism along z or a lens. A lens is a polygon normal to z
// with a point on either side of it. For other bodies the work is cubic.
[[nodiscard]] bool features_are_plain(const Body& body);

}  // namespace clearance::oracle
