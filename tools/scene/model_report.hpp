// Reports the models of every object of a cell from coarse to fine, with their sizes and errors.
#pragma once

#include <string>

#include "config/scene.hpp"

namespace clearance {

// A table with one line for each object, and an explanation of its columns.
[[nodiscard]] std::string model_table(const Scene& scene);

// The same as JSON: an array of objects, lengths in m.
[[nodiscard]] std::string model_json(const Scene& scene);

}  // namespace clearance
