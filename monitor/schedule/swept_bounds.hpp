// Bounds of a pair's distance since the last tick.
#pragma once

#include "core/convex_body.hpp"

namespace clearance {

struct SweptBounds {
  double lower = -kInfinity;  // at every instant, m
  double upper = kInfinity;   // at some instant, m
};

}  // namespace clearance
