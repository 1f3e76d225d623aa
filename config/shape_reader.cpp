// One function for each key reads its numbers and lets the core build the body. The core decides
// what is a solid convex body; its reason for refusing one goes into the message.
#include "config/shape_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include "config/mesh_file.hpp"
#include "config/spelling.hpp"

namespace clearance {
namespace {

// Keys of shapes, in the order in which messages list them.
const std::array<std::string, 7> kShapeKinds = {"box",        "sphere",     "capsule", "prism",
                                                "polyhedron", "half_space", "mesh"};

// Zero would flatten the mesh; the largest is far beyond every conversion of units.
constexpr Range kScales{.least = 0.0, .most = 1e9, .above_least = true};

// The conditions on a shape as a whole, beyond those that are checked number by number.
std::string solid_needs(const std::string& kind) {
  if (kind == "capsule") return "two different ends (where they are one point, write a sphere)";
  if (kind == "prism") {
    return "a base of at least three vertices, not all on one line, and a lower z below the upper";
  }
  if (kind == "polyhedron") {
    return "at least four vertices, not all in one plane, or half-spaces with a common interior";
  }
  if (kind == "mesh") return "a mesh with at least four vertices, not all in one plane";
  return fmt::format("a {} of ordinary size", kind);
}

// A mesh's own coordinates to metres.
std::vector<Vec3> scaled(const std::vector<Vec3>& vertices, const Vec3& scale, LengthUnit unit) {
  std::vector<Vec3> placed;
  placed.reserve(vertices.size());
  for (const Vec3& v : vertices) {
    placed.emplace_back(metres(v.x() * scale.x(), unit), metres(v.y() * scale.y(), unit),
                        metres(v.z() * scale.z(), unit));
  }
  return placed;
}

}  // namespace

std::span<const std::string> ShapeReader::kinds() { return kShapeKinds; }

// Exactly one shape key must be there; two would leave one of them out in silence. The shape itself
// is made by the core, whose reason for refusing it goes into the message.
std::optional<NamedShape> ShapeReader::read(MapReader& map, const YamlNode& at) {
  NamedShape found{"", nullptr, {}};
  for (const std::string& kind : kShapeKinds) {
    const YamlNode* node = map.optional(kind);
    if (node == nullptr) continue;
    if (found.node != nullptr) {
      quantities_.diagnostics().add(
          *node,
          fmt::format("found '{}' beside '{}'; expected one shape a part", kind, found.kind));
      return std::nullopt;
    }
    found.kind = kind;
    found.node = node;
  }
  if (found.node == nullptr) {
    if (map.is_map()) {
      quantities_.diagnostics().add(
          at, fmt::format("found no shape; expected one of {}", one_of(kShapeKinds)));
    }
    return std::nullopt;
  }
  std::optional<ShapeResult> result = read_kind(found.kind, *found.node);
  if (!result) return std::nullopt;
  if (const auto* error = std::get_if<ShapeError>(&*result)) {
    quantities_.diagnostics().add(
        *found.node, fmt::format("found a {} that is not a solid convex body ({}); expected {}",
                                 found.kind, error->reason, solid_needs(found.kind)));
    return std::nullopt;
  }
  found.shape = std::get<ConvexPolyhedron>(std::move(*result));
  return found;
}

// A chain of comparisons instead of a table: seven kinds, read once for each part.
std::optional<ShapeResult> ShapeReader::read_kind(const std::string& kind, const YamlNode& node) {
  if (kind == "box") return read_box(node);
  if (kind == "sphere") return read_sphere(node);
  if (kind == "capsule") return read_capsule(node);
  if (kind == "prism") return read_prism(node);
  if (kind == "polyhedron") return read_polyhedron(node);
  if (kind == "half_space") return read_half_space(node);
  return read_mesh(node);
}

// The file has whole edge lengths, the core takes half ones.
std::optional<ShapeResult> ShapeReader::read_box(const YamlNode& node) const {
  MapReader map(node, "a box", quantities_.diagnostics());
  const YamlNode* size_node = map.required("size");
  map.refuse_unknown_keys();
  if (size_node == nullptr) return std::nullopt;
  const auto size = quantities_.lengths(*size_node, "the box's edge lengths", kPositive);
  return size ? std::optional(box(0.5 * *size)) : std::nullopt;
}

// A point with a radius: the core represents it as a swept sphere, exactly.
std::optional<ShapeResult> ShapeReader::read_sphere(const YamlNode& node) const {
  MapReader map(node, "a sphere", quantities_.diagnostics());
  const YamlNode* radius_node = map.required("radius");
  const YamlNode* centre_node = map.optional("centre");
  map.refuse_unknown_keys();
  std::optional<double> radius;
  std::optional<Vec3> centre = Vec3(Vec3::Zero());
  if (radius_node != nullptr) radius = quantities_.length(*radius_node, "the radius", kPositive);
  if (centre_node != nullptr) centre = quantities_.lengths(*centre_node, "the sphere's centre");
  if (!radius || !centre) return std::nullopt;
  return point(*centre, *radius);
}

// A capsule is a segment with a radius: the core represents it as a swept sphere.
std::optional<ShapeResult> ShapeReader::read_capsule(const YamlNode& node) const {
  MapReader map(node, "a capsule", quantities_.diagnostics());
  const YamlNode* from_node = map.required("from");
  const YamlNode* to_node = map.required("to");
  const YamlNode* radius_node = map.required("radius");
  map.refuse_unknown_keys();
  std::optional<Vec3> from, to;
  std::optional<double> radius;
  if (from_node != nullptr) from = quantities_.lengths(*from_node, "one end of the capsule's axis");
  if (to_node != nullptr) to = quantities_.lengths(*to_node, "the other end of the capsule's axis");
  if (radius_node != nullptr) radius = quantities_.length(*radius_node, "the radius", kPositive);
  if (!from || !to || !radius) return std::nullopt;
  return segment(*from, *to, *radius);
}

// The hull of the base polygon at both heights, which need not be convex as written.
std::optional<ShapeResult> ShapeReader::read_prism(const YamlNode& node) const {
  MapReader map(node, "a prism", quantities_.diagnostics());
  const YamlNode* base_node = map.required("base");
  const YamlNode* z_node = map.required("z");
  map.refuse_unknown_keys();
  if (base_node == nullptr || z_node == nullptr) return std::nullopt;
  std::vector<Vec2> base;
  const auto& vertices = read_list(*base_node, "vertices [x, y]", quantities_.diagnostics());
  for (const YamlNode& vertex : vertices) {
    if (const auto xy = quantities_.lengths_2d(vertex, "a vertex [x, y]")) base.push_back(*xy);
  }
  const auto z = quantities_.lengths_2d(*z_node, "the prism's lower and upper z");
  if (!z || base.empty() || base.size() != vertices.size()) return std::nullopt;
  return prism(base, z->x(), z->y());
}

// A half-space n . x <= d, its plane given by d or by a point.
std::optional<HalfSpace> ShapeReader::read_row(const YamlNode& node) const {
  Diagnostics& diagnostics = quantities_.diagnostics();
  MapReader map(node, "a half-space", diagnostics);
  const YamlNode* normal_node = map.required("normal");
  const YamlNode* offset_node = map.optional("offset");
  const YamlNode* through_node = map.optional("through");
  map.refuse_unknown_keys();
  if (map.is_map() && (offset_node == nullptr) == (through_node == nullptr)) {
    diagnostics.add(node, fmt::format("found {} of 'offset' and 'through'; expected one of the two",
                                      offset_node == nullptr ? "neither" : "both"));
    return std::nullopt;
  }
  std::optional<Vec3> normal;
  if (normal_node != nullptr) normal = quantities_.direction(*normal_node, "the outward normal");
  if (through_node != nullptr) {
    const auto through = quantities_.lengths(*through_node, "a point of the plane");
    if (!normal || !through) return std::nullopt;
    return HalfSpace{*normal, normal->dot(*through)};
  }
  std::optional<double> offset;
  if (offset_node != nullptr) {
    offset = quantities_.length(*offset_node, "the offset d of normal . x <= d,");
  }
  if (!normal || !offset) return std::nullopt;
  return HalfSpace{*normal, *offset};
}

// An unbounded polyhedron of one row; objects refuse it unless they are fixed.
std::optional<ShapeResult> ShapeReader::read_half_space(const YamlNode& node) const {
  const auto row = read_row(node);
  return row ? std::optional(polyhedron_from_halfspaces(std::array{*row})) : std::nullopt;
}

// By its vertices or by its half-spaces; nothing is made of a list with a mistake in it, since a
// body with one vertex less would be wrong rather than missing.
std::optional<ShapeResult> ShapeReader::read_polyhedron(const YamlNode& node) const {
  Diagnostics& diagnostics = quantities_.diagnostics();
  MapReader map(node, "a polyhedron", diagnostics);
  const YamlNode* vertices_node = map.optional("vertices");
  const YamlNode* rows_node = map.optional("half_spaces");
  map.refuse_unknown_keys();
  if (map.is_map() && (vertices_node == nullptr) == (rows_node == nullptr)) {
    diagnostics.add(node,
                    fmt::format("found {} of 'vertices' and 'half_spaces'; expected one of the two",
                                rows_node == nullptr ? "neither" : "both"));
    return std::nullopt;
  }
  // Diagnostics of this body only: others of the file do not make it wrong.
  const std::size_t before = diagnostics.count();
  if (vertices_node != nullptr) {
    std::vector<Vec3> vertices;
    for (const YamlNode& item : read_list(*vertices_node, "vertices [x, y, z]", diagnostics)) {
      if (const auto vertex = quantities_.lengths(item, "a vertex")) vertices.push_back(*vertex);
    }
    if (diagnostics.count() != before) return std::nullopt;
    return polyhedron_from_vertices(vertices);
  }
  if (rows_node == nullptr) return std::nullopt;
  std::vector<HalfSpace> rows;
  for (const YamlNode& item : read_list(*rows_node, "half-spaces {normal, offset}", diagnostics)) {
    if (const auto row = read_row(item)) rows.push_back(*row);
  }
  if (diagnostics.count() != before) return std::nullopt;
  return polyhedron_from_halfspaces(rows);
}

// One factor, or one for each axis; negative ones mirror.
Vec3 ShapeReader::read_scale(const YamlNode* node) const {
  if (node == nullptr) return Vec3::Ones();
  if (node->kind != YamlNode::Kind::kSequence) {
    const auto scale =
        read_number(*node, kScales, "a scale, or a list of 3", quantities_.diagnostics());
    return Vec3::Constant(scale.value_or(1.0));
  }
  const Vec3 scale =
      quantities_.direction(*node, "the scale along x, y and z").value_or(Vec3::Ones());
  if ((scale.array() == 0.0).any()) {
    quantities_.diagnostics().add(*node, "found a scale of 0; expected no zeros");
  }
  return scale;
}

// Each file is read once, however many parts use it, and its bytes go into the scene's revision:
// two scenes with different meshes must not pass for one.
const std::vector<Vec3>* ShapeReader::load(const YamlNode& file_node, const std::string& file) {
  const std::filesystem::path path = directory_ / file;
  const auto [entry, is_new] = meshes_.try_emplace(path.string());
  std::optional<std::vector<Vec3>>& vertices = entry->second;
  if (is_new) {
    const auto bytes = read_bytes(path.string());
    if (const auto* fault = std::get_if<MeshFault>(&bytes)) {
      quantities_.diagnostics().add(file_node,
                                    fmt::format("found a mesh file that cannot be used: {}; "
                                                "expected a path relative to the cell file",
                                                fault->reason));
      return nullptr;
    }
    // Once for each file: parts that share a mesh add nothing to the revision.
    revision_.add(std::get<std::string>(bytes));
    auto result = mesh_vertices(std::get<std::string>(bytes), path.extension().string());
    if (const auto* fault = std::get_if<MeshFault>(&result)) {
      quantities_.diagnostics().add(
          file_node, fmt::format("found a mesh file that cannot be used: '{}': {}; "
                                 "expected an undamaged mesh with faces, in one file",
                                 path.string(), fault->reason));
      return nullptr;
    }
    vertices = std::get<std::vector<Vec3>>(std::move(result));
  }
  return vertices ? &*vertices : nullptr;
}

std::optional<ShapeResult> ShapeReader::read_mesh(const YamlNode& node) {
  Diagnostics& diagnostics = quantities_.diagnostics();
  MapReader map(node, "a mesh", diagnostics);
  const YamlNode* file_node = map.required("file");
  const YamlNode* scale_node = map.optional("scale");
  const YamlNode* unit_node = map.optional("unit");
  const YamlNode* reach_node = map.optional("reach");
  map.refuse_unknown_keys();
  const std::size_t before = diagnostics.count();
  MeshUse use{.file = "", .scale = read_scale(scale_node), .unit = quantities_.units().length};
  if (reach_node != nullptr) {
    use.reach = quantities_.length(*reach_node, "the largest coordinate of the mesh", kPositive)
                    .value_or(use.reach);
  }
  if (unit_node != nullptr) use.unit = read_length_unit(*unit_node, diagnostics).value_or(use.unit);
  if (file_node == nullptr) return std::nullopt;
  const auto file = read_text(*file_node, "the path of a mesh file", diagnostics);
  if (!file || diagnostics.count() != before) return std::nullopt;
  use.file = *file;
  return mesh_hull(use, *file_node, node);
}

std::optional<ShapeResult> ShapeReader::mesh_hull(const MeshUse& use, const YamlNode& file_node,
                                                  const YamlNode& node) {
  const std::vector<Vec3>* vertices = load(file_node, use.file);
  if (vertices == nullptr) return std::nullopt;
  // Checked after scaling: a wrong unit shows as a mesh of a thousand times the size.
  const std::vector<Vec3> placed = scaled(*vertices, use.scale, use.unit);
  for (const Vec3& vertex : placed) {
    const double farthest = vertex.cwiseAbs().maxCoeff();
    if (farthest <= use.reach) continue;
    quantities_.diagnostics().add(
        node, fmt::format("found a mesh with a vertex {:.4g} m from its origin along an axis; "
                          "expected another unit or scale, or, where the body reaches farther than "
                          "{:g} m, 'reach' beside 'file'",
                          farthest, use.reach));
    return std::nullopt;
  }
  return polyhedron_from_vertices(placed);
}

}  // namespace clearance
