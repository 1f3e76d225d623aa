// Simpler models around the bodies of a mesh, a cell or a robot: a table of what each costs and how
// far it reaches beyond the body, and the chosen one as a part to paste into a cell.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/enclosing_models.hpp"

namespace clearance {

struct ReductionOptions {
  std::filesystem::path file;         // a cell (.yaml, .yml), a robot (.urdf) or a mesh
  std::string object;                 // of a cell or robot; empty: all
  std::optional<double> tolerance;    // m: the cheapest model whose error is no more
  std::optional<std::size_t> facets;  // the least error of polyhedra with no more facets
  bool time = false;                  // measure queries
};

// One body with its models, from the simplest on.
struct Reduction {
  std::string name;
  std::size_t facets = 0, vertices = 0;
  std::vector<EnclosingModel> models;
  std::vector<double> query_ns;  // one a model where they were measured
  std::optional<std::size_t> chosen;
};

// What was made, and notes on objects that were left out; or why nothing could be.
struct Reductions {
  std::vector<Reduction> bodies;
  std::vector<std::string> notes;
};
[[nodiscard]] std::variant<Reductions, std::vector<std::string>> reduce(
    const ReductionOptions& options);

[[nodiscard]] std::string reduction_table(const std::vector<Reduction>& bodies);
[[nodiscard]] std::string reduction_json(const std::vector<Reduction>& bodies);

// The model as an item of a cell's `parts`, lengths in m.
[[nodiscard]] std::string part_yaml(const EnclosingModel& model);

}  // namespace clearance
