// Reads the convex shapes of a cell file, which stand under `box:`, `mesh:` and similar keys.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "config/map_reader.hpp"
#include "config/quantities.hpp"
#include "config/revision.hpp"
#include "core/shapes.hpp"

namespace clearance {

// A shape and where it stands in the file, for messages about it.
struct NamedShape {
  std::string kind;  // the key: "box"
  const YamlNode* node;
  ConvexPolyhedron shape;
};

// A mesh file and how its coordinates become metres.
struct MeshUse {
  std::string file;  // relative to the reader's directory
  Vec3 scale = Vec3::Ones();
  LengthUnit unit = LengthUnit::kMetre;
  // No vertex may be farther from the mesh's origin along an axis, m: one wrong number in a file,
  // or a file in another unit, makes a body of kilometres, of which every distance would be 0.
  double reach = 100.0;
};

// Lengths are converted to metres here; what the core gets is SI. Mesh files are read once and kept
// by path as long as the reader lives.
class ShapeReader {
 public:
  // Mesh paths are relative to `directory`; the bytes of every mesh go into `revision` once.
  ShapeReader(const Quantities& quantities, std::filesystem::path directory, Revision& revision)
      : quantities_(quantities), directory_(std::move(directory)), revision_(revision) {}

  // "box", "sphere", ...: the keys of which a part has exactly one.
  [[nodiscard]] static std::span<const std::string> kinds();

  // Reads the one shape among the keys of `map`; reports when there is none, or more, or a bad
  // one. `at` is the map's own node.
  [[nodiscard]] std::optional<NamedShape> read(MapReader& map, const YamlNode& at);

  // The hull of all vertices of a mesh, which contains it; nothing after a diagnostic. `file_node`
  // is where the file is named, `node` where its size is.
  [[nodiscard]] std::optional<ShapeResult> mesh_hull(const MeshUse& use, const YamlNode& file_node,
                                                     const YamlNode& node);

 private:
  std::optional<ShapeResult> read_kind(const std::string& kind, const YamlNode& node);
  std::optional<ShapeResult> read_box(const YamlNode& node) const;
  std::optional<ShapeResult> read_sphere(const YamlNode& node) const;
  std::optional<ShapeResult> read_capsule(const YamlNode& node) const;
  std::optional<ShapeResult> read_prism(const YamlNode& node) const;
  std::optional<ShapeResult> read_half_space(const YamlNode& node) const;
  std::optional<ShapeResult> read_polyhedron(const YamlNode& node) const;
  std::optional<ShapeResult> read_mesh(const YamlNode& node);
  // One inequality normal . x <= offset, in metres.
  std::optional<HalfSpace> read_row(const YamlNode& node) const;
  Vec3 read_scale(const YamlNode* node) const;
  // The vertices of a mesh file in its own unit; null after a diagnostic.
  const std::vector<Vec3>* load(const YamlNode& file_node, const std::string& file);

  const Quantities& quantities_;
  std::filesystem::path directory_;
  Revision& revision_;
  std::map<std::string, std::optional<std::vector<Vec3>>> meshes_;  // by path; nothing: a bad one
};

}  // namespace clearance
