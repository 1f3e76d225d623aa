// One function for each key reads its numbers and lets the core build the body. The core decides
// which bodies are solid and convex; its reason for refusing one goes into the message.
#include "config/cell/shape_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "config/text/sentences.hpp"

namespace clearance {
namespace {

// The keys of shapes, in the order in which messages list them.
const std::array<std::string, 11> kShapeKinds = {
    "box",  "sphere",    "capsule",  "prism", "polyhedron",    "half_space",
    "mesh", "ellipsoid", "cylinder", "cone",  "truncated_cone"};

// Zero would flatten the mesh. The largest factor is far above every conversion of units.
constexpr Range kScales{.least = 0.0, .most = 1e9, .above_least = true};

// More parts of a mesh take long to find, and each is a row of queries.
constexpr std::int64_t kMostParts = 64;

// Returns the conditions on a shape as a whole, in addition to those on single numbers.
std::string solid_needs(const std::string& kind) {
  if (kind == "capsule") return "two different ends (where they are one point, write a sphere)";
  if (kind == "prism") {
    return "a base of at least three vertices, not all on one line, and a lower z below the upper";
  }
  if (kind == "polyhedron") {
    return "at least four vertices, not all in one plane, or half-spaces with a common interior";
  }
  if (kind == "mesh") return "a mesh with at least three vertices, not all on one line";
  return fmt::format("a {} of ordinary size", kind);
}

}  // namespace

void read_part_limits(MapReader& map, const Quantities& quantities, PartLimits& limits) {
  if (const YamlNode* node = map.optional("tolerance")) {
    limits.tolerance =
        quantities.length(*node, "how far the parts of a mesh may reach beyond it", kPositive)
            .value_or(limits.tolerance);
  }
  if (const YamlNode* node = map.optional("max_parts")) {
    const auto most =
        read_integer(*node, 1, kMostParts, "parts of a mesh at most", quantities.diagnostics());
    if (most) limits.max_parts = static_cast<std::size_t>(*most);
  }
  if (const YamlNode* node = map.optional("plate_thickness")) {
    limits.plate =
        quantities.length(*node, "the thickness of a flat mesh", kPositive).value_or(limits.plate);
  }
}

std::string name_of_part(const std::string& name, std::size_t i, std::size_t count) {
  return count == 1 ? name : fmt::format("{}.{}", name, i);
}

std::span<const std::string> ShapeReader::kinds() { return kShapeKinds; }

// Exactly one shape key is required, because one of two would silently be left out. The core makes
// the shape, and its reason for refusing one goes into the message.
std::optional<NamedShape> ShapeReader::read(MapReader& map, const YamlNode& at) {
  NamedShape found{"", nullptr, {}, 0.0};
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
  auto result = read_kind(found.kind, *found.node);
  if (!result) return std::nullopt;
  if (const auto* error = std::get_if<ShapeError>(&*result)) {
    quantities_.diagnostics().add(
        *found.node, fmt::format("found a {} that is not a solid convex body ({}); expected {}",
                                 found.kind, error->reason, solid_needs(found.kind)));
    return std::nullopt;
  }
  auto& parts = std::get<MeshParts>(*result);
  found.shapes = std::move(parts.shapes);
  found.mesh_error = parts.error;
  return found;
}

std::optional<std::variant<MeshParts, ShapeError>> ShapeReader::read_kind(const std::string& kind,
                                                                          const YamlNode& node) {
  if (kind == "mesh") return read_mesh(node);
  std::optional<ShapeResult> result = read_simple_kind(kind, node);
  if (!result) return std::nullopt;
  if (auto* error = std::get_if<ShapeError>(&*result)) return std::move(*error);
  MeshParts one;
  one.shapes.push_back(std::get<ConvexBody>(std::move(*result)));
  return one;
}

// A chain of comparisons serves as well as a table: there are few kinds, each read once a part.
std::optional<ShapeResult> ShapeReader::read_simple_kind(const std::string& kind,
                                                         const YamlNode& node) {
  if (kind == "box") return read_box(node);
  if (kind == "sphere") return read_sphere(node);
  if (kind == "capsule") return read_capsule(node);
  if (kind == "prism") return read_prism(node);
  if (kind == "polyhedron") return read_polyhedron(node);
  if (kind == "half_space") return read_half_space(node);
  if (kind == "ellipsoid") return read_ellipsoid(node);
  if (kind == "cylinder" || kind == "cone") return read_cylinder_or_cone(kind, node);
  return read_truncated_cone(node);
}

// Reads `rounding: r`, which most solids may have: the body is all points within r of the shape.
std::optional<double> ShapeReader::read_rounding(MapReader& map) const {
  const YamlNode* node = map.optional("rounding");
  if (node == nullptr) return 0.0;
  return quantities_.length(*node, "the radius around the body", kPositive);
}

// Adds the radius that `rounding:` states around the body.
std::optional<ShapeResult> ShapeReader::rounded(std::optional<double> rounding, ShapeResult made) {
  auto* body = std::get_if<ConvexBody>(&made);
  if (!rounding) return std::nullopt;
  return body == nullptr ? std::move(made) : rounded_by(*rounding, std::move(*body));
}

// The file has whole edge lengths; the core has half edge lengths.
std::optional<ShapeResult> ShapeReader::read_box(const YamlNode& node) const {
  MapReader map(node, "a box", quantities_.diagnostics());
  const YamlNode* size_node = map.required("size");
  const auto rounding = read_rounding(map);
  map.refuse_unknown_keys();
  if (size_node == nullptr) return std::nullopt;
  const auto size = quantities_.lengths(*size_node, "the box's edge lengths", kPositive);
  return size ? rounded(rounding, box(0.5 * *size)) : std::nullopt;
}

// The ellipsoid is centred at the origin, along the axes.
std::optional<ShapeResult> ShapeReader::read_ellipsoid(const YamlNode& node) const {
  MapReader map(node, "an ellipsoid", quantities_.diagnostics());
  const YamlNode* axes_node = map.required("semi_axes");
  const auto rounding = read_rounding(map);
  map.refuse_unknown_keys();
  if (axes_node == nullptr || !rounding) return std::nullopt;
  const auto axes = quantities_.lengths(*axes_node, "the ellipsoid's semi-axes", kPositive);
  return axes ? std::optional(ellipsoid(*axes, *rounding)) : std::nullopt;
}

// The body is centred and lies along z. The file has the whole length, as URDF does; the core has
// half of it.
std::optional<ShapeResult> ShapeReader::read_cylinder_or_cone(const std::string& kind,
                                                              const YamlNode& node) const {
  MapReader map(node, "a " + kind, quantities_.diagnostics());
  const YamlNode* radius_node = map.required("radius");
  const YamlNode* length_node = map.required("length");
  const auto rounding = read_rounding(map);
  map.refuse_unknown_keys();
  std::optional<double> radius, length;
  if (radius_node != nullptr) radius = quantities_.length(*radius_node, "the radius", kPositive);
  if (length_node != nullptr) length = quantities_.length(*length_node, "the length", kPositive);
  if (!radius || !length || !rounding) return std::nullopt;
  const double half = 0.5 * *length;
  return kind == "cone" ? cone(*radius, half, *rounding) : cylinder(*radius, half, *rounding);
}

// One end may be a point.
std::optional<ShapeResult> ShapeReader::read_truncated_cone(const YamlNode& node) const {
  MapReader map(node, "a truncated cone", quantities_.diagnostics());
  const YamlNode* lower_node = map.required("lower_radius");
  const YamlNode* upper_node = map.required("upper_radius");
  const YamlNode* length_node = map.required("length");
  const auto rounding = read_rounding(map);
  map.refuse_unknown_keys();
  std::optional<double> lower, upper, length;
  if (lower_node != nullptr) {
    lower = quantities_.length(*lower_node, "the radius of the lower end", kNotNegative);
  }
  if (upper_node != nullptr) {
    upper = quantities_.length(*upper_node, "the radius of the upper end", kNotNegative);
  }
  if (length_node != nullptr) length = quantities_.length(*length_node, "the length", kPositive);
  if (!lower || !upper || !length || !rounding) return std::nullopt;
  return truncated_cone(*lower, *upper, 0.5 * *length, *rounding);
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

// A prism is the hull of the base polygon at both heights; the polygon need not be convex as
// written.
std::optional<ShapeResult> ShapeReader::read_prism(const YamlNode& node) const {
  MapReader map(node, "a prism", quantities_.diagnostics());
  const YamlNode* base_node = map.required("base");
  const YamlNode* z_node = map.required("z");
  const auto rounding = read_rounding(map);
  map.refuse_unknown_keys();
  if (base_node == nullptr || z_node == nullptr) return std::nullopt;
  std::vector<Vec2> base;
  const auto& vertices = read_list(*base_node, "vertices [x, y]", quantities_.diagnostics());
  for (const YamlNode& vertex : vertices) {
    if (const auto xy = quantities_.lengths_2d(vertex, "a vertex [x, y]")) base.push_back(*xy);
  }
  const auto z = quantities_.lengths_2d(*z_node, "the prism's lower and upper z");
  if (!z || base.empty() || base.size() != vertices.size()) return std::nullopt;
  return rounded(rounding, prism(base, z->x(), z->y()));
}

// Reads a half-space n . x <= d, whose plane is given by d or by a point.
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

// Reads vertices or half-spaces. A list with a mistake makes no body, since a body with one vertex
// less would be wrong rather than missing.
std::optional<ShapeResult> ShapeReader::read_polyhedron(const YamlNode& node) const {
  Diagnostics& diagnostics = quantities_.diagnostics();
  MapReader map(node, "a polyhedron", diagnostics);
  const YamlNode* vertices_node = map.optional("vertices");
  const YamlNode* rows_node = map.optional("half_spaces");
  const auto rounding = read_rounding(map);
  map.refuse_unknown_keys();
  if (map.is_map() && (vertices_node == nullptr) == (rows_node == nullptr)) {
    diagnostics.add(node,
                    fmt::format("found {} of 'vertices' and 'half_spaces'; expected one of the two",
                                rows_node == nullptr ? "neither" : "both"));
    return std::nullopt;
  }
  // Only diagnostics of this body make it wrong.
  const std::size_t before = diagnostics.count();
  if (vertices_node != nullptr) {
    std::vector<Vec3> vertices;
    for (const YamlNode& item : read_list(*vertices_node, "vertices [x, y, z]", diagnostics)) {
      if (const auto vertex = quantities_.lengths(item, "a vertex")) vertices.push_back(*vertex);
    }
    if (diagnostics.count() != before) return std::nullopt;
    return rounded(rounding, polyhedron_from_vertices(vertices));
  }
  if (rows_node == nullptr) return std::nullopt;
  std::vector<HalfSpace> rows;
  for (const YamlNode& item : read_list(*rows_node, "half-spaces {normal, offset}", diagnostics)) {
    if (const auto row = read_row(item)) rows.push_back(*row);
  }
  if (diagnostics.count() != before) return std::nullopt;
  return rounded(rounding, polyhedron_from_halfspaces(rows));
}

// Reads one factor, or one for each axis; negative ones mirror.
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

std::optional<std::variant<MeshParts, ShapeError>> ShapeReader::read_mesh(const YamlNode& node) {
  Diagnostics& diagnostics = quantities_.diagnostics();
  MapReader map(node, "a mesh", diagnostics);
  const YamlNode* file_node = map.required("file");
  const YamlNode* scale_node = map.optional("scale");
  const YamlNode* unit_node = map.optional("unit");
  const YamlNode* reach_node = map.optional("reach");
  const std::size_t before = diagnostics.count();
  MeshUse use{.file = "", .unit = quantities_.units().length, .limits = limits_};
  read_part_limits(map, quantities_, use.limits);
  const auto rounding = read_rounding(map);
  map.refuse_unknown_keys();
  use.scale = read_scale(scale_node);
  if (reach_node != nullptr) {
    use.reach = quantities_.length(*reach_node, "the largest coordinate of the mesh", kPositive)
                    .value_or(use.reach);
  }
  if (unit_node != nullptr) use.unit = read_length_unit(*unit_node, diagnostics).value_or(use.unit);
  if (file_node == nullptr) return std::nullopt;
  const auto file = read_text(*file_node, "the path of a mesh file", diagnostics);
  if (!file || !rounding || diagnostics.count() != before) return std::nullopt;
  use.file = *file;
  auto made = mesh_parts(use);
  if (const auto* mistake = std::get_if<MeshMistake>(&made)) {
    diagnostics.add(mistake->is_of_size ? node : *file_node, mistake->text);
    return std::nullopt;
  }
  if (auto* error = std::get_if<ShapeError>(&made)) return std::move(*error);
  auto parts = std::get<MeshParts>(std::move(made));
  for (ConvexBody& shape : parts.shapes) {
    ShapeResult round = rounded_by(*rounding, std::move(shape));
    if (auto* error = std::get_if<ShapeError>(&round)) return std::move(*error);
    shape = std::get<ConvexBody>(std::move(round));
  }
  return parts;
}

std::variant<MeshParts, ShapeError, MeshMistake> ShapeReader::mesh_parts(const MeshUse& use) {
  auto result = meshes_.parts(use);
  if (auto* parts = std::get_if<MeshParts>(&result)) return std::move(*parts);
  auto& refusal = std::get<MeshRefusal>(result);
  switch (refusal.kind) {
    case MeshRefusal::Kind::kFile:
      return MeshMistake{
          false,
          fmt::format("found a mesh file that cannot be used: {}; expected a path relative to the "
                      "file that names it",
                      refusal.reason)};
    case MeshRefusal::Kind::kDamaged:
      return MeshMistake{false,
                         fmt::format("found a mesh file that cannot be used: {}; expected an "
                                     "undamaged mesh with faces, in one file",
                                     refusal.reason)};
    case MeshRefusal::Kind::kTooLarge:
      return MeshMistake{true,
                         fmt::format("found a mesh with a vertex {} from its origin along an axis; "
                                     "expected another unit or scale, or, where the body reaches "
                                     "farther than {:g} m, 'reach' beside 'file'",
                                     refusal.reason, use.reach)};
    case MeshRefusal::Kind::kNotSolid:
      break;
  }
  return ShapeError{std::move(refusal.reason)};
}

}  // namespace clearance
