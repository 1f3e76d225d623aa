// The part of a ConvexPolyhedron that repeats it in the order in which queries walk it.
#pragma once

#include "core/convex_polyhedron.hpp"

namespace clearance {

// Fills `outgoing`, `facet_limits`, `planes` and `start` from the rest, and keeps no memory to
// spare. The factories' last step.
void add_walking_tables(ConvexPolyhedron& body);

}  // namespace clearance
