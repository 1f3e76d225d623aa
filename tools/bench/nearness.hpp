// Whether a query of curved bodies costs more the nearer or the thinner they are.
#pragma once

namespace clearance::bench {

// nearness/cold/KIND/GAP and nearness/tracked/KIND/GAP for every kind of nearness.cpp and every gap
// of 1e-9 to 1e3 of the bodies' larger semi-axes: 60 random pairs just so far apart. Counters:
// iterations, support points, mean; most_iterations; wide: queries whose bounds are farther apart
// than 1e-13 of sizes and distance.
void register_nearness();

}  // namespace clearance::bench
