// The bodies that are to be reduced: of meshes, cells and robots.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/enclosing_models.hpp"

namespace clearance {

// Convex parts, the union of which holds a body.
struct PartsModel {
  std::vector<EnclosingModel> parts;  // polyhedra in the body's frame
  // No point of the union's surface is farther than this from the body, m. Of a mesh: from its
  // triangles (config/decomposition/surface_error.hpp).
  double error = 0.0;
};

struct Original {
  std::string name;
  ConvexBody hull;
  double hull_error = 0.0;        // m, as PartsModel::error
  std::vector<PartsModel> parts;  // with more and more of them; none where the hull will do
};

// And notes on objects that were left out.
struct Originals {
  std::vector<Original> bodies;
  std::vector<std::string> notes;
};

// Of cells (.yaml, .yml), robots (.urdf) and meshes; `object`: of cells and robots only this one,
// if not empty. Meshes are split into 2, 4, 8 and 16 parts, unless their hull reaches less than
// 0.5 % of its radius beyond them. Or what is wrong.
[[nodiscard]] std::variant<Originals, std::vector<std::string>> read_originals(
    std::span<const std::filesystem::path> files, const std::string& object);

}  // namespace clearance
