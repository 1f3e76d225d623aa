// Limits of splitting a mesh.
#pragma once

#include <cstddef>

namespace clearance {

struct PartLimits {
  double tolerance = 5e-3;     // m, the largest distance by which parts may exceed the mesh
  std::size_t max_parts = 24;  // the search ends here, even where the tolerance is not met
  double plate = 1e-3;         // m, > 0: the thickness that a flat mesh gets, half on either side
};

}  // namespace clearance
