#include "tools/scene/reduction.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/scene/originals.hpp"
#include "tools/scene/query_time.hpp"

namespace clearance {
namespace {

// A model's rank by the cost of a tracked query against a box; --time measures that cost.
std::size_t rank(const ReducedModel& model) {
  const std::size_t parts = 1000 * (model.parts.size() - 1);
  switch (model.parts.front().kind) {
    case ModelKind::kSphere:
      return 0;
    case ModelKind::kCapsule:
      return 1;
    case ModelKind::kBox:
      return 2;
    case ModelKind::kRoundedBox:
      return 3;
    case ModelKind::kPolyhedron:
      return 4 + parts + model.facets();
    case ModelKind::kCylinder:
    case ModelKind::kEllipsoid:
      break;
  }
  return 1 << 20;
}

bool is_cheaper(const ReducedModel& left, const ReducedModel& right) {
  return left.time && right.time ? left.time->tracked < right.time->tracked
                                 : rank(left) < rank(right);
}

std::optional<std::size_t> choice(const Reduction& made, const ReductionOptions& options) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < made.models.size(); ++i) {
    const ReducedModel& model = made.models[i];
    if (options.tolerance) {
      if (model.error <= *options.tolerance && (!best || is_cheaper(model, made.models[*best]))) {
        best = i;
      }
    } else if (options.facets) {
      const bool is_polyhedron = model.facets() > 0 && model.parts.front().shape.radius == 0.0;
      if (!is_polyhedron || model.facets() > *options.facets) continue;
      if (!best || model.error < made.models[*best].error) best = i;
    }
  }
  return best;
}

// Adds the hull's own error to that of a model around the hull.
ReducedModel around(EnclosingModel model, double hull_error) {
  ReducedModel made{name(model.kind), {}, model.error + hull_error, {}};
  made.parts.push_back(std::move(model));
  return made;
}

Reduction reduction_of(Original original, const ReductionOptions& options) {
  Reduction made;
  made.name = std::move(original.name);
  made.facets = original.hull.facets.size();
  made.vertices = original.hull.vertices.size();
  const double hull_error = original.hull_error;
  for (EnclosingModel& model : enclosing_models(original.hull)) {
    made.models.push_back(around(std::move(model), hull_error));
  }
  if (options.facets) {
    made.models.push_back(around(enclosing_facets(original.hull, *options.facets), hull_error));
  }
  EnclosingModel hull{ModelKind::kPolyhedron, std::move(original.hull), Pose{}};
  hull.error = hull.shape.position_error;
  made.models.push_back(around(std::move(hull), hull_error));
  made.models.back().name = "hull";
  for (PartsModel& parts : original.parts) {
    made.models.push_back(
        {fmt::format("{} parts", parts.parts.size()), std::move(parts.parts), parts.error, {}});
  }
  if (options.time || !options.distances.empty()) measure_queries(made.models);
  made.chosen = choice(made, options);
  return made;
}

}  // namespace

std::size_t ReducedModel::facets() const {
  std::size_t all = 0;
  for (const EnclosingModel& part : parts) all += part.shape.facets.size();
  return all;
}

std::vector<Level> levels_of(const Reduction& body) {
  std::vector<Level> levels;
  for (const ReducedModel& model : body.models) {
    if (model.time) levels.push_back({model.error, model.time->cold});
  }
  return levels;
}

std::variant<Reductions, std::vector<std::string>> reduce(const ReductionOptions& options) {
  auto read = read_originals(options.files, options.object);
  if (auto* faults = std::get_if<std::vector<std::string>>(&read)) return std::move(*faults);
  Originals& originals = std::get<Originals>(read);
  Reductions all;
  all.notes = std::move(originals.notes);
  for (Original& original : originals.bodies) {
    all.bodies.push_back(reduction_of(std::move(original), options));
  }
  return all;
}

}  // namespace clearance
