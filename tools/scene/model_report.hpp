// The models of every object of a cell, from coarse to fine: how large they are, how far off.
#pragma once

#include <string>

#include "config/scene.hpp"

namespace clearance {

// A table, a line an object, and what it means.
[[nodiscard]] std::string model_table(const Scene& scene);

// The same as JSON: an array of objects, lengths in m.
[[nodiscard]] std::string model_json(const Scene& scene);

}  // namespace clearance
