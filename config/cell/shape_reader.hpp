// Reads the convex shapes of a cell file, which stand under `box:`, `mesh:` and similar keys.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "config/mesh/mesh_parts.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"
#include "core/shapes.hpp"

namespace clearance {

// A shape and its place in the file, for messages.
struct NamedShape {
  std::string kind;  // the key: "box"
  const YamlNode* node;
  std::vector<ConvexBody> shapes;  // one, or the parts that contain a mesh
  double mesh_error = 0.0;         // the largest distance by which these exceed the mesh, m
};

// Reads `tolerance` and `max_parts` of a map; stated values replace those of `limits`.
void read_part_limits(MapReader& map, const Quantities& quantities, PartLimits& limits);

// Returns the name of part i of `count` parts of one shape: "palm.3".
[[nodiscard]] std::string name_of_part(const std::string& name, std::size_t i, std::size_t count);

// Lengths are converted to metres here; the core has SI units.
class ShapeReader {
 public:
  // `limits` hold for meshes that do not state their own.
  ShapeReader(const Quantities& quantities, MeshLibrary& meshes, const PartLimits& limits)
      : quantities_(quantities), meshes_(meshes), limits_(limits) {}

  // Returns the keys of shapes, of which a part has exactly one: "box", "sphere", ...
  [[nodiscard]] static std::span<const std::string> kinds();

  // Reads the one shape among the keys of `map`; reports none, several, or a bad one. `at` is the
  // map's own node.
  [[nodiscard]] std::optional<NamedShape> read(MapReader& map, const YamlNode& at);

  // Returns the parts of a mesh, or nothing if a fault was reported. Faults of the file are
  // reported at `file_node`, and faults of its size at `node`.
  [[nodiscard]] std::optional<std::variant<MeshParts, ShapeError>> mesh_parts(
      const MeshUse& use, const YamlNode& file_node, const YamlNode& node);

 private:
  std::optional<std::variant<MeshParts, ShapeError>> read_kind(const std::string& kind,
                                                               const YamlNode& node);
  std::optional<ShapeResult> read_simple_kind(const std::string& kind, const YamlNode& node);
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
  std::optional<std::variant<MeshParts, ShapeError>> read_mesh(const YamlNode& node);
  // One inequality normal . x <= offset, in metres.
  std::optional<HalfSpace> read_row(const YamlNode& node) const;
  std::optional<double> read_rounding(MapReader& map) const;
  static std::optional<ShapeResult> rounded(std::optional<double> rounding, ShapeResult made);
  Vec3 read_scale(const YamlNode* node) const;
  const Quantities& quantities_;
  MeshLibrary& meshes_;
  PartLimits limits_;
};

}  // namespace clearance
