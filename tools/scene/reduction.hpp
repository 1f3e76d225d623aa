// Simpler models around the bodies of meshes, cells or robots: a table of what each costs and how
// far it reaches beyond the body, the one that costs least at a given distance and speed, and the
// chosen one as parts to paste into a cell.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/enclosing_models.hpp"
#include "tools/scene/watching.hpp"

namespace clearance {

struct ReductionOptions {
  std::vector<std::filesystem::path> files;  // cells (.yaml, .yml), robots (.urdf), meshes
  std::string object;                        // of cells and robots; empty: all
  std::optional<double> tolerance;           // m: the cheapest model whose error is no more
  std::optional<std::size_t> facets;         // the least error of polyhedra with no more facets
  bool time = false;                         // measure queries
  std::vector<double> distances;             // m: where to ask for the cheapest, see Watching
  double speed = 1.0;                        // m/s, the same
};

// One convex body around another one, or several whose union holds it.
struct ReducedModel {
  std::string name;
  std::vector<EnclosingModel> parts;
  double error = kInfinity;        // m: no point of its surface is farther from the body
  std::optional<QueryTimes> time;  // where it was measured

  [[nodiscard]] std::size_t facets() const;
};

struct Reduction {
  std::string name;
  std::size_t facets = 0, vertices = 0;  // of the hull
  std::vector<ReducedModel> models;      // from the simplest on: the hull, then parts, come last
  std::optional<std::size_t> chosen;
};

// What was made, and notes on objects that were left out; or why nothing could be.
struct Reductions {
  std::vector<Reduction> bodies;
  std::vector<std::string> notes;
};
[[nodiscard]] std::variant<Reductions, std::vector<std::string>> reduce(
    const ReductionOptions& options);

// "capsule", "32 facets", "2 parts".
[[nodiscard]] std::string label_of(const ReducedModel& model);

// For people, m: rounded upwards to 0.01 mm; what is only rounding is 0.
[[nodiscard]] double rounded_up_error(double error);

// Errors and cold times of a body's models, in their order; none where nothing was measured. The
// broad phase asks its models cold.
[[nodiscard]] std::vector<Level> levels_of(const Reduction& body);

[[nodiscard]] std::string reduction_table(const std::vector<Reduction>& bodies,
                                          const ReductionOptions& options);
[[nodiscard]] std::string reduction_json(const std::vector<Reduction>& bodies,
                                         const ReductionOptions& options);

// The same for a page, with a picture `svg` beside it.
[[nodiscard]] std::string reduction_page(const std::vector<Reduction>& bodies,
                                         const ReductionOptions& options, const std::string& svg);
// Error against time a query, a panel a body, and which model is the cheapest at the options'
// distances. Empty, or what went wrong.
[[nodiscard]] std::string plot_reductions(const std::vector<Reduction>& bodies,
                                          const ReductionOptions& options,
                                          const std::filesystem::path& svg);

// The model as items of a cell's `parts`, lengths in m.
[[nodiscard]] std::string parts_yaml(const ReducedModel& model);

}  // namespace clearance
