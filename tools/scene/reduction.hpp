// Makes simpler models around the bodies of meshes, cells or robots. Prints a table of their costs
// and errors, and the cheapest model at a given distance and speed. It also prints the chosen model
// as parts for a cell.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tools/scene/fitting/enclosing_models.hpp"
#include "tools/scene/watching.hpp"

namespace clearance {

struct ReductionOptions {
  std::vector<std::filesystem::path> files;  // cells (.yaml, .yml), robots (.urdf), meshes
  std::string object;                        // or link; empty: all
  std::optional<double> tolerance;           // m: choose the cheapest with at most this error
  std::optional<std::size_t> facets;         // choose the best with at most so many facets
  bool time = false;                         // measure queries
  std::vector<double> distances;             // m: Watching::distance
  double speed = 1.0;                        // m/s: Watching::speed
};

// One convex body around another one, or several bodies whose union holds it.
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
  std::vector<ReducedModel> models;      // simplest first; the hull and the parts come last
  std::optional<std::size_t> chosen;
};

// The models, and notes on objects that were left out.
struct Reductions {
  std::vector<Reduction> bodies;
  std::vector<std::string> notes;
};
[[nodiscard]] std::variant<Reductions, std::vector<std::string>> reduce(
    const ReductionOptions& options);

// "capsule", "32 facets", "2 parts".
[[nodiscard]] std::string label_of(const ReducedModel& model);

// The error as it is printed, m: rounded upwards to 0.01 mm; 0 for an error of mere rounding.
[[nodiscard]] double rounded_up_error(double error);

// Errors and cold times of a body's models, in their order; empty where nothing was measured. The
// queries of the broad phase are cold.
[[nodiscard]] std::vector<Level> levels_of(const Reduction& body);

[[nodiscard]] std::string reduction_table(const std::vector<Reduction>& bodies,
                                          const ReductionOptions& options);
[[nodiscard]] std::string reduction_json(const std::vector<Reduction>& bodies,
                                         const ReductionOptions& options);

// The same as a page in Markdown, with a picture `svg` beside it.
[[nodiscard]] std::string reduction_page(const std::vector<Reduction>& bodies,
                                         const ReductionOptions& options, const std::string& svg);
// Draws error against time per query, one panel per body, and the cheapest model at the options'
// distances. Returns an empty text, or the fault.
[[nodiscard]] std::string plot_reductions(const std::vector<Reduction>& bodies,
                                          const ReductionOptions& options,
                                          const std::filesystem::path& svg);

// The model as items of a cell's `parts`, lengths in m.
[[nodiscard]] std::string parts_yaml(const ReducedModel& model);

}  // namespace clearance
