// Reports the models of every object of a cell from coarse to fine, with their sizes and errors.
#pragma once

#include <map>
#include <string>

#include "config/scene/scene.hpp"

namespace clearance {

// Maps an object's name to the error of its parts against its meshes, m (CellOptions::mesh_errors).
using MeshErrors = std::map<std::string, double>;

// A table with one line for each object, and an explanation of its columns.
[[nodiscard]] std::string model_table(const Scene& scene, const MeshErrors& mesh_errors);

// The same as JSON: an array of objects, lengths in m.
[[nodiscard]] std::string model_json(const Scene& scene, const MeshErrors& mesh_errors);

}  // namespace clearance
