// Reads the bodies that are to be reduced, from meshes, cells and robots.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "tools/scene/fitting/enclosing_models.hpp"

namespace clearance {

// Convex parts whose union holds a body.
struct PartsModel {
  std::vector<EnclosingModel> parts;  // polyhedra in the body's frame
  // No point of the union's surface is farther than this from the body, m. For a mesh, the
  // distance is from its triangles (config/decomposition/surface_error.hpp).
  double error = 0.0;
};

struct Original {
  std::string name;
  ConvexBody hull;
  double hull_error = 0.0;        // m, as PartsModel::error
  std::vector<PartsModel> parts;  // by rising number of parts; none where the hull suffices
};

// The bodies, and notes on objects that were left out.
struct Originals {
  std::vector<Original> bodies;
  std::vector<std::string> notes;
};

// Reads cells (.yaml, .yml), robots (.urdf) and meshes, or returns the mistakes in them. `object`,
// if not empty, selects an object of a cell or a link of a robot. A mesh is split into 2, 4, 8 and
// 16 parts. It is not split if the error of its hull is less than 0.5 % of the hull's radius.
[[nodiscard]] std::variant<Originals, std::vector<std::string>> read_originals(
    std::span<const std::filesystem::path> files, const std::string& object);

}  // namespace clearance
