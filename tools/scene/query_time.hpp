// How long queries against models take.
#pragma once

#include "tools/scene/reduction.hpp"

namespace clearance {

// Measures each model in turn, 15 times, and takes the least of each: wall time a query against a
// box of a quarter of the largest model's size, which goes round at two and a half times that size
// in steps of 5 mm a metre. Of several parts: all of them.
void measure_queries(std::vector<ReducedModel>& models);

}  // namespace clearance
