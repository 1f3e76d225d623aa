// Reads the convex shapes of a cell file, which stand under `box:`, `mesh:` and similar keys.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include "config/mesh/mesh_parts.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/quantities.hpp"
#include "core/shapes.hpp"

namespace clearance {

// A mesh that cannot be used: what was found, and what was expected of its size or of its file.
struct MeshMistake {
  bool is_of_size;
  std::string text;
};

// A shape and its place in the file, for messages.
struct NamedShape {
  std::string kind;  // the key: "box"
  const YamlNode* node;
  std::vector<ConvexBody> shapes;  // one, or the parts that contain a mesh
  double mesh_error = 0.0;         // the largest distance by which these exceed the mesh, m
};

// Reads `tolerance`, `max_parts` and `plate_thickness` of a map; stated values replace those of
// `limits`.
void read_part_limits(MapReader& map, const Quantities& quantities, PartLimits& limits);

// Returns the name of part i of `count` parts of one shape: "palm.3".
[[nodiscard]] std::string name_of_part(const std::string& name, std::size_t i, std::size_t count);

// The bodies of shapes that were read before, by what the cell says of them: to make a polyhedron
// exactly takes up to milliseconds.
using ConvexShapes = std::unordered_map<std::string, ConvexBody>;

// Lengths are converted to metres here; the core has SI units.
class ShapeReader {
 public:
  // `limits` hold for meshes that do not state their own. `known` gets every shape that is read.
  ShapeReader(const Quantities& quantities, MeshLibrary& meshes, const PartLimits& limits,
              ConvexShapes& known)
      : quantities_(quantities), meshes_(meshes), limits_(limits), known_(known) {}

  // Returns the keys of shapes: "box", "sphere", ... A part has exactly one of them.
  [[nodiscard]] static std::span<const std::string> kinds();

  // Reads the one shape among the keys of `map`; reports none, several, or a bad one. `at` is the
  // map's own node.
  [[nodiscard]] std::optional<NamedShape> read(MapReader& map, const YamlNode& at);

  // Returns the parts of a mesh; reports nothing.
  [[nodiscard]] std::variant<MeshParts, ShapeError, MeshMistake> mesh_parts(const MeshUse& use);

 private:
  std::optional<std::variant<MeshParts, ShapeError>> read_kind(const std::string& kind,
                                                               const YamlNode& node);
  std::optional<std::variant<MeshParts, ShapeError>> read_mesh(const YamlNode& node);
  Vec3 read_scale(const YamlNode* node) const;
  const Quantities& quantities_;
  MeshLibrary& meshes_;
  PartLimits limits_;
  ConvexShapes& known_;
};

}  // namespace clearance
