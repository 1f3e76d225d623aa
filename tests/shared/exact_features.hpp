// The directions in which an exact body has facets and edges.
#pragma once

#include <vector>

#include "tests/shared/exact_body.hpp"

namespace clearance::oracle {

// In the body's own frame, any length; more directions than there are, and with repetitions. A
// normal leads outwards.
struct Features {
  std::vector<RationalVec> normals, edges;
};

[[nodiscard]] Features features_of(const Body& body);

// Is that no more work than there are rows or points? So it is of what these show to be a prism
// along z, or a lens: a polygon across z and a point on either side of it. Of others it takes the
// cube.
[[nodiscard]] bool features_are_plain(const Body& body);

}  // namespace clearance::oracle
