// Chapter 5's methods on its own test, the crossed ellipsoids of semi-axes [1 2 5] and [5 2 1]:
// rows ellipsoids/METHOD/SEPARATION.
#pragma once

namespace clearance::bench {

void register_ellipsoids();

}  // namespace clearance::bench
