#include "tools/scene/originals.hpp"

#include <algorithm>
#include <optional>

#include "config/cell/cell_file.hpp"
#include "config/decomposition/convex_parts.hpp"
#include "config/decomposition/surface_error.hpp"
#include "config/mesh/mesh_file.hpp"
#include "config/text/file_bytes.hpp"
#include "config/write/single_robot_cell.hpp"
#include "core/shapes.hpp"
#include "monitor/app/program.hpp"
#include "monitor/geometry/bounding_hull.hpp"
#include "tools/scene/fitting/certified_error.hpp"

namespace clearance {
namespace {

using Faults = std::vector<std::string>;

// A mesh whose hull has at most this error, as a share of the hull's radius, is not split.
constexpr double kConvexEnough = 0.005;
// Far more than the rounding of placed parts, as a share of their size.
constexpr double kRounding = 1e-12;

EnclosingModel part_of(ConvexBody shape, const Pose& pose) {
  EnclosingModel part{ModelKind::kPolyhedron, std::move(shape), pose};
  part.error = part.shape.position_error;
  return part;
}

// Adds a fan of triangles for each facet, in the object's frame.
void add_facets(const Part& part, TriangleMesh& mesh) {
  const ConvexBody& shape = part.shape;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& p : shape.anchors) mesh.vertices.push_back(transform(part.object_from_part, p));
  const auto number = [first](std::int32_t anchor) {
    return first + static_cast<std::uint32_t>(anchor);
  };
  for (const Facet& facet : shape.facets) {
    for (std::int32_t i = 0; i < facet.sides; ++i) {
      const EdgeUse& side = shape.facet_edges[static_cast<std::size_t>(facet.first_side + i)];
      const Edge& edge = shape.edges[static_cast<std::size_t>(side.edge)];
      mesh.triangles.push_back(
          {number(facet.anchor), number(edge.vertex[0]), number(edge.vertex[1])});
    }
  }
}

// Returns the error of a hull around several parts: the smaller one of two bounds. surface_error()
// bounds the distance of the hull's surface from the parts' surfaces, to 2 %. certified_error()
// bounds points inside the hull as well, but less closely if there are many facets.
double hull_error_of(const Object& object, const ConvexBody& hull) {
  TriangleMesh surface;
  for (const Part& part : object.parts) add_facets(part, surface);
  const double rounding = kRounding * hull.bounding_radius;
  return std::min(certified_error(hull, Pose{}, shapes_of(object)),
                  surface_error({&hull, 1}, TriangleTree(surface)) + rounding);
}

// Returns nothing where one of the parts is curved, rounded or unbounded.
std::optional<Original> original_of(const Object& object) {
  std::vector<Vec3> points;
  PartsModel own;
  for (const Part& part : object.parts) {
    const ConvexBody& shape = part.shape;
    if (shape.is_curved() || shape.radius > 0.0 || !shape.bounded()) return std::nullopt;
    for (const Vec3& p : shape.anchors) points.push_back(transform(part.object_from_part, p));
    own.error = std::max(own.error, shape.position_error);
    own.parts.push_back(part_of(shape, part.object_from_part));
  }
  ShapeResult hull = polyhedron_from_vertices(points);
  auto* body = std::get_if<ConvexBody>(&hull);
  if (body == nullptr) return std::nullopt;
  Original original{object.name, std::move(*body), 0.0, {}};
  if (object.parts.size() == 1) return original;
  original.hull_error = hull_error_of(object, original.hull);
  original.parts.push_back(std::move(own));
  return original;
}

// Returns nothing if there are no more parts than `already`.
std::optional<PartsModel> split(const TriangleMesh& mesh, const PartLimits& limits,
                                std::size_t already) {
  const auto found = convex_parts(mesh, limits);
  const auto* made = std::get_if<ConvexParts>(&found);
  if (made == nullptr || made->parts.size() <= already) return std::nullopt;
  PartsModel model;
  model.error = made->error;
  for (const std::vector<Vec3>& vertices : made->parts) {
    ShapeResult part = polyhedron_from_vertices(vertices);
    if (!std::holds_alternative<ConvexBody>(part)) return std::nullopt;
    model.parts.push_back(part_of(std::get<ConvexBody>(std::move(part)), Pose{}));
  }
  return model;
}

std::variant<Original, Faults> original_of(const std::filesystem::path& file) {
  const auto bytes = read_bytes(file);
  if (const auto* fault = std::get_if<FileFault>(&bytes)) return Faults{fault->reason};
  const auto read = read_mesh(std::get<std::string>(bytes), file.extension());
  if (const auto* fault = std::get_if<MeshFault>(&read)) {
    return Faults{"'" + file.string() + "' " + fault->reason};
  }
  const TriangleMesh& mesh = std::get<TriangleMesh>(read);
  ShapeResult hull = polyhedron_from_vertices(mesh.vertices);
  if (const auto* error = std::get_if<ShapeError>(&hull)) {
    return Faults{"'" + file.string() + "': " + error->reason};
  }
  Original original{file.stem(), std::get<ConvexBody>(std::move(hull)), 0.0, {}};
  original.hull_error = surface_error({&original.hull, 1}, TriangleTree(mesh));
  const double enough = kConvexEnough * original.hull.bounding_radius;
  if (original.hull_error <= enough) return original;
  std::size_t parts = 1;
  for (const std::size_t most : {2, 4, 8, 16}) {
    // Two parts often bring nothing where four do, as for a box without a lid.
    auto model = split(mesh, {.tolerance = enough, .max_parts = most}, parts);
    if (!model) continue;
    parts = model->parts.size();
    original.parts.push_back(std::move(*model));
  }
  return original;
}

std::variant<Scene, Faults> scene_of(const std::filesystem::path& file) {
  CellResult cell = file.extension() == ".urdf"
                        ? read_single_robot({.urdf = file}, told_on_stderr())
                        : read_cell(file, told_on_stderr());
  if (auto* read = std::get_if<Cell>(&cell)) return std::move(read->scene);
  Faults texts;
  for (const CellError& error : std::get<std::vector<CellError>>(cell)) texts.push_back(error.text);
  return texts;
}

Faults add_objects(const std::filesystem::path& file, const std::string& only, Originals& all) {
  auto scene = scene_of(file);
  if (auto* faults = std::get_if<Faults>(&scene)) return std::move(*faults);
  bool found = false;
  for (const Object& object : std::get<Scene>(scene).objects) {
    if (!only.empty() && object.name != only) continue;
    found = true;
    if (auto original = original_of(object)) {
      all.bodies.push_back(std::move(*original));
    } else {
      all.notes.push_back(object.name +
                          " is left out: it has a part that is curved, rounded or unbounded");
    }
  }
  if (!found) return {"--object " + only + ": there is no such object"};
  return {};
}

}  // namespace

std::variant<Originals, Faults> read_originals(std::span<const std::filesystem::path> files,
                                               const std::string& object) {
  Originals all;
  for (const std::filesystem::path& file : files) {
    const std::string kind = file.extension();
    if (kind == ".yaml" || kind == ".yml" || kind == ".urdf") {
      Faults faults = add_objects(file, object, all);
      if (!faults.empty()) return faults;
      continue;
    }
    auto mesh = original_of(file);
    if (auto* faults = std::get_if<Faults>(&mesh)) return std::move(*faults);
    all.bodies.push_back(std::get<Original>(std::move(mesh)));
  }
  return all;
}

}  // namespace clearance
