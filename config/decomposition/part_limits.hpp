// How far, and into how many parts, a mesh is split.
#pragma once

#include <cstddef>

namespace clearance {

struct PartLimits {
  double tolerance = 5e-3;     // m
  std::size_t max_parts = 24;  // the search ends here, even where the tolerance is not met
};

}  // namespace clearance
