// Measures the time of queries against models.
#pragma once

#include "tools/scene/reduction.hpp"

namespace clearance {

// Measures each model in turn, 15 times, and keeps its least wall time per query. The queries are
// against a box of a quarter of the largest model's size. The box circles at two and a half times
// that size, in steps of 5 mm per metre. A query against several parts asks all of them.
void measure_queries(std::vector<ReducedModel>& models);

}  // namespace clearance
