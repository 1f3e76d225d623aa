// Measures how long queries against models take.
#pragma once

#include "tools/scene/reduction.hpp"

namespace clearance {

// Measures each model in turn, 15 times, and keeps its least time: wall time per query against a
// box of a quarter of the largest model's size. The box circles at two and a half times that size,
// in steps of 5 mm per metre. A query against several parts asks all of them.
void measure_queries(std::vector<ReducedModel>& models);

}  // namespace clearance
