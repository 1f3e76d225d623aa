// One function for each key reads its numbers and lets the core build the body.
#include "config/cell/convex_shape_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <variant>
#include <vector>

namespace clearance {
namespace {

class ConvexShapeReader {
 public:
  explicit ConvexShapeReader(const Quantities& quantities) : quantities_(quantities) {}

  std::optional<ShapeResult> read(const std::string& kind, const YamlNode& node) const;

 private:
  std::optional<ShapeResult> read_box(const YamlNode& node) const;
  std::optional<ShapeResult> read_sphere(const YamlNode& node) const;
  std::optional<ShapeResult> read_capsule(const YamlNode& node) const;
  std::optional<ShapeResult> read_ellipsoid(const YamlNode& node) const;
  std::optional<ShapeResult> read_cylinder_or_cone(const std::string& kind,
                                                   const YamlNode& node) const;
  std::optional<ShapeResult> read_truncated_cone(const YamlNode& node) const;
  std::optional<ShapeResult> read_prism(const YamlNode& node) const;
  std::optional<ShapeResult> read_half_space(const YamlNode& node) const;
  std::optional<ShapeResult> read_polyhedron(const YamlNode& node) const;
  // One inequality normal . x <= offset, in metres.
  std::optional<HalfSpace> read_row(const YamlNode& node) const;
  static std::optional<ShapeResult> rounded(std::optional<double> rounding, ShapeResult made);

  const Quantities& quantities_;
};

// A chain of comparisons serves as well as a table: there are few kinds, each read once per part.
std::optional<ShapeResult> ConvexShapeReader::read(const std::string& kind,
                                                   const YamlNode& node) const {
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

// Adds the radius that `rounding:` states around the body.
std::optional<ShapeResult> ConvexShapeReader::rounded(std::optional<double> rounding,
                                                      ShapeResult made) {
  auto* body = std::get_if<ConvexBody>(&made);
  if (!rounding) return std::nullopt;
  return body == nullptr ? std::move(made) : rounded_by(*rounding, std::move(*body));
}

// The file has whole edge lengths; the core has half edge lengths.
std::optional<ShapeResult> ConvexShapeReader::read_box(const YamlNode& node) const {
  MapReader map(node, "a box", quantities_.diagnostics());
  const YamlNode* size_node = map.required("size");
  const auto rounding = read_rounding(map, quantities_);
  map.refuse_unknown_keys();
  if (size_node == nullptr) return std::nullopt;
  const auto size = quantities_.lengths(*size_node, "the box's edge lengths", kPositive);
  return size ? rounded(rounding, box(0.5 * *size)) : std::nullopt;
}

// The ellipsoid is centred at the origin, along the axes.
std::optional<ShapeResult> ConvexShapeReader::read_ellipsoid(const YamlNode& node) const {
  MapReader map(node, "an ellipsoid", quantities_.diagnostics());
  const YamlNode* axes_node = map.required("semi_axes");
  const auto rounding = read_rounding(map, quantities_);
  map.refuse_unknown_keys();
  if (axes_node == nullptr || !rounding) return std::nullopt;
  const auto axes = quantities_.lengths(*axes_node, "the ellipsoid's semi-axes", kPositive);
  return axes ? std::optional(ellipsoid(*axes, *rounding)) : std::nullopt;
}

// The body is centred and lies along z. The file has the whole length, as URDF does; the core has
// half of it.
std::optional<ShapeResult> ConvexShapeReader::read_cylinder_or_cone(const std::string& kind,
                                                                    const YamlNode& node) const {
  MapReader map(node, "a " + kind, quantities_.diagnostics());
  const YamlNode* radius_node = map.required("radius");
  const YamlNode* length_node = map.required("length");
  const auto rounding = read_rounding(map, quantities_);
  map.refuse_unknown_keys();
  std::optional<double> radius, length;
  if (radius_node != nullptr) radius = quantities_.length(*radius_node, "the radius", kPositive);
  if (length_node != nullptr) length = quantities_.length(*length_node, "the length", kPositive);
  if (!radius || !length || !rounding) return std::nullopt;
  const double half = 0.5 * *length;
  return kind == "cone" ? cone(*radius, half, *rounding) : cylinder(*radius, half, *rounding);
}

// One end may be a point.
std::optional<ShapeResult> ConvexShapeReader::read_truncated_cone(const YamlNode& node) const {
  MapReader map(node, "a truncated cone", quantities_.diagnostics());
  const YamlNode* lower_node = map.required("lower_radius");
  const YamlNode* upper_node = map.required("upper_radius");
  const YamlNode* length_node = map.required("length");
  const auto rounding = read_rounding(map, quantities_);
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
std::optional<ShapeResult> ConvexShapeReader::read_sphere(const YamlNode& node) const {
  MapReader map(node, "a sphere", quantities_.diagnostics());
  const YamlNode* radius_node = map.required("radius");
  const YamlNode* centre_node = map.optional("centre");
  map.refuse_unknown_keys();
  std::optional<double> radius;
  std::optional<Vec3> centre = Vec3(Vec3::Zero());
  if (radius_node != nullptr) radius = quantities_.length(*radius_node, "the radius", kNotNegative);
  if (centre_node != nullptr) centre = quantities_.lengths(*centre_node, "the sphere's centre");
  if (!radius || !centre) return std::nullopt;
  return point(*centre, *radius);
}

// A capsule is a segment with a radius: the core represents it as a swept sphere.
std::optional<ShapeResult> ConvexShapeReader::read_capsule(const YamlNode& node) const {
  MapReader map(node, "a capsule", quantities_.diagnostics());
  const YamlNode* from_node = map.required("from");
  const YamlNode* to_node = map.required("to");
  const YamlNode* radius_node = map.required("radius");
  map.refuse_unknown_keys();
  std::optional<Vec3> from, to;
  std::optional<double> radius;
  if (from_node != nullptr) from = quantities_.lengths(*from_node, "one end of the capsule's axis");
  if (to_node != nullptr) to = quantities_.lengths(*to_node, "the other end of the capsule's axis");
  if (radius_node != nullptr) radius = quantities_.length(*radius_node, "the radius", kNotNegative);
  if (!from || !to || !radius) return std::nullopt;
  return segment(*from, *to, *radius);
}

// A prism is the hull of the base polygon at both heights; the polygon need not be convex as
// written.
std::optional<ShapeResult> ConvexShapeReader::read_prism(const YamlNode& node) const {
  MapReader map(node, "a prism", quantities_.diagnostics());
  const YamlNode* base_node = map.required("base");
  const YamlNode* z_node = map.required("z");
  const auto rounding = read_rounding(map, quantities_);
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
std::optional<HalfSpace> ConvexShapeReader::read_row(const YamlNode& node) const {
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
std::optional<ShapeResult> ConvexShapeReader::read_half_space(const YamlNode& node) const {
  const auto row = read_row(node);
  return row ? std::optional(polyhedron_from_halfspaces(std::array{*row})) : std::nullopt;
}

// Reads vertices or half-spaces. A list with a mistake makes no body, since a body with one vertex
// less would be wrong rather than missing.
std::optional<ShapeResult> ConvexShapeReader::read_polyhedron(const YamlNode& node) const {
  Diagnostics& diagnostics = quantities_.diagnostics();
  MapReader map(node, "a polyhedron", diagnostics);
  const YamlNode* vertices_node = map.optional("vertices");
  const YamlNode* rows_node = map.optional("half_spaces");
  const auto rounding = read_rounding(map, quantities_);
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

}  // namespace

std::optional<ShapeResult> read_convex_shape(const std::string& kind, const YamlNode& node,
                                             const Quantities& quantities) {
  return ConvexShapeReader(quantities).read(kind, node);
}

std::optional<double> read_rounding(MapReader& map, const Quantities& quantities) {
  const YamlNode* node = map.optional("rounding");
  if (node == nullptr) return 0.0;
  return quantities.length(*node, "the radius around the body", kPositive);
}

}  // namespace clearance
