// How long queries against models take.
#pragma once

#include <span>
#include <vector>

#include "core/enclosing_models.hpp"

namespace clearance {

// Of each model, ns: a tracked distance query against a box of half its size, which turns around it
// in steps of 2 mrad at twice its size. The median of several rounds, in which the models take
// turns: what else the machine does meets all of them alike.
[[nodiscard]] std::vector<double> query_times(std::span<const EnclosingModel> models);

}  // namespace clearance
