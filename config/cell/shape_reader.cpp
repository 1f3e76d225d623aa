// The core decides which bodies are solid and convex; its reason for refusing one goes into the
// message.
#include "config/cell/shape_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "config/cell/convex_shape_reader.hpp"
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
  std::string key = fmt::format("{} {} ", kind, static_cast<int>(quantities_.units().length));
  add_content(node, key);
  MeshParts one;
  if (const auto known = known_.find(key); known != known_.end()) {
    one.shapes.push_back(known->second);
    return one;
  }
  const std::size_t before = quantities_.diagnostics().count();
  std::optional<ShapeResult> result = read_convex_shape(kind, node, quantities_);
  if (!result) return std::nullopt;
  if (auto* error = std::get_if<ShapeError>(&*result)) return std::move(*error);
  one.shapes.push_back(std::get<ConvexBody>(std::move(*result)));
  if (quantities_.diagnostics().count() == before)
    known_.emplace(std::move(key), one.shapes.front());
  return one;
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
  const auto rounding = read_rounding(map, quantities_);
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
