#include "tools/scene/reduction.hpp"

#include <algorithm>

#include "config/cell_file.hpp"
#include "config/mesh_file.hpp"
#include "config/single_robot_cell.hpp"
#include "core/shapes.hpp"
#include "monitor/app/program.hpp"
#include "tools/scene/query_time.hpp"

namespace clearance {
namespace {

using Faults = std::vector<std::string>;

struct NamedBody {
  std::string name;
  ConvexPolyhedron body;
};

// Cheapest first: what a tracked query against a box takes (--time measures it).
int rank(const EnclosingModel& model) {
  switch (model.kind) {
    case ModelKind::kSphere:
      return 0;
    case ModelKind::kCapsule:
      return 1;
    case ModelKind::kBox:
      return 2;
    case ModelKind::kRoundedBox:
      return 3;
    case ModelKind::kPolyhedron:
      return 4 + static_cast<int>(model.shape.facets.size());
    case ModelKind::kCylinder:
    case ModelKind::kEllipsoid:
      break;
  }
  return 1 << 20;
}

// The hull of the object's parts in its frame; nothing where one of them is curved, rounded or
// unbounded.
std::optional<ConvexPolyhedron> hull_of(const Object& object) {
  std::vector<Vec3> points;
  for (const Part& part : object.parts) {
    const ConvexPolyhedron& shape = part.shape;
    if (shape.is_curved() || shape.radius > 0.0 || !shape.bounded()) return std::nullopt;
    for (const Vec3& p : shape.anchors) points.push_back(transform(part.object_from_part, p));
  }
  ShapeResult hull = polyhedron_from_vertices(points);
  if (auto* body = std::get_if<ConvexPolyhedron>(&hull)) return std::move(*body);
  return std::nullopt;
}

std::variant<Scene, Faults> scene_of(const ReductionOptions& options) {
  CellResult cell = options.file.extension() == ".urdf"
                        ? read_single_robot({.urdf = options.file}, told_on_stderr())
                        : read_cell(options.file, told_on_stderr());
  if (auto* scene = std::get_if<Scene>(&cell)) return std::move(*scene);
  Faults texts;
  for (const CellError& error : std::get<std::vector<CellError>>(cell)) texts.push_back(error.text);
  return texts;
}

std::variant<NamedBody, Faults> mesh_of(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  if (const auto* fault = std::get_if<MeshFault>(&bytes)) return Faults{fault->reason};
  const auto mesh = read_mesh(std::get<std::string>(bytes), file.extension());
  if (const auto* fault = std::get_if<MeshFault>(&mesh)) {
    return Faults{"'" + file.string() + "' " + fault->reason};
  }
  ShapeResult hull = polyhedron_from_vertices(std::get<TriangleMesh>(mesh).vertices);
  if (const auto* error = std::get_if<ShapeError>(&hull)) {
    return Faults{"'" + file.string() + "': " + error->reason};
  }
  return NamedBody{file.stem(), std::get<ConvexPolyhedron>(std::move(hull))};
}

std::variant<std::vector<NamedBody>, Faults> bodies_of(const ReductionOptions& options,
                                                       std::vector<std::string>& notes) {
  const std::string kind = options.file.extension();
  if (kind != ".yaml" && kind != ".yml" && kind != ".urdf") {
    auto mesh = mesh_of(options.file);
    if (auto* faults = std::get_if<Faults>(&mesh)) return std::move(*faults);
    std::vector<NamedBody> one;
    one.push_back(std::get<NamedBody>(std::move(mesh)));
    return one;
  }
  auto scene = scene_of(options);
  if (auto* faults = std::get_if<Faults>(&scene)) return std::move(*faults);
  std::vector<NamedBody> bodies;
  bool found = false;
  for (const Object& object : std::get<Scene>(scene).objects) {
    if (!options.object.empty() && object.name != options.object) continue;
    found = true;
    if (auto hull = hull_of(object)) {
      bodies.push_back({object.name, std::move(*hull)});
    } else {
      notes.push_back(object.name +
                      " is left out: it has a part that is curved, rounded or unbounded");
    }
  }
  if (!found) return Faults{"--object " + options.object + ": there is no such object"};
  return bodies;
}

std::optional<std::size_t> choice(const Reduction& made, const ReductionOptions& options) {
  std::optional<std::size_t> best;
  const auto cheaper = [&](std::size_t i, std::size_t j) {
    if (!made.query_ns.empty()) return made.query_ns[i] < made.query_ns[j];
    return rank(made.models[i]) < rank(made.models[j]);
  };
  for (std::size_t i = 0; i < made.models.size(); ++i) {
    const EnclosingModel& model = made.models[i];
    if (options.tolerance) {
      if (model.error <= *options.tolerance && (!best || cheaper(i, *best))) best = i;
    } else if (options.facets) {
      const std::size_t facets = model.shape.facets.size();
      if (facets == 0 || facets > *options.facets || model.shape.radius > 0.0) continue;
      if (!best || model.error < made.models[*best].error) best = i;
    }
  }
  return best;
}

Reduction reduction_of(NamedBody named, const ReductionOptions& options) {
  Reduction made;
  made.name = std::move(named.name);
  made.facets = named.body.facets.size();
  made.vertices = named.body.vertices.size();
  made.models = enclosing_models(named.body);
  if (options.facets) made.models.push_back(enclosing_facets(named.body, *options.facets));
  // The body itself, of no error.
  EnclosingModel itself{ModelKind::kPolyhedron, std::move(named.body), Pose{}};
  itself.error = itself.shape.position_error;
  made.models.push_back(std::move(itself));
  if (options.time) made.query_ns = query_times(made.models);
  made.chosen = choice(made, options);
  return made;
}

}  // namespace

std::variant<Reductions, Faults> reduce(const ReductionOptions& options) {
  Reductions all;
  auto bodies = bodies_of(options, all.notes);
  if (auto* faults = std::get_if<Faults>(&bodies)) return std::move(*faults);
  for (NamedBody& named : std::get<std::vector<NamedBody>>(bodies)) {
    all.bodies.push_back(reduction_of(std::move(named), options));
  }
  return all;
}

}  // namespace clearance
