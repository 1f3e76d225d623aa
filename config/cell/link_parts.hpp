// Makes the convex parts of a link from its collision shapes.
#pragma once

#include <optional>
#include <variant>

#include "config/cell/shape_reader.hpp"
#include "config/scene/scene.hpp"
#include "config/urdf/robot_files.hpp"
#include "config/urdf/urdf.hpp"
#include "config/yaml/diagnostics.hpp"

namespace clearance {

// Reports every fault of a robot's description at the place where the cell names the file.
void refuse_robot(const YamlNode& at, const UrdfFaults& faults, Diagnostics& diagnostics);

// Tells where a person can say which directory a package has.
[[nodiscard]] PackagesFrom packages_from(const Diagnostics& diagnostics);

// A mesh becomes parts that contain it: the link never becomes smaller.
class LinkParts {
 public:
  // `files` are those of the URDF. The cell names it at `urdf_node`, where mistakes are reported.
  LinkParts(RobotFiles files, const YamlNode& urdf_node, ShapeReader& shapes,
            const PartLimits& limits, Diagnostics& diagnostics)
      : urdf_(files.named_in.string()),
        meshes_(std::move(files), packages_from(diagnostics)),
        at_(urdf_node),
        shapes_(shapes),
        limits_(limits),
        diagnostics_(diagnostics) {}

  // Adds parts, named after their kind and place in the link, except those that were reported.
  // Returns the largest distance by which parts exceed their meshes, m.
  double add(const UrdfLink& link, Object& object);

 private:
  std::optional<std::variant<MeshParts, ShapeError>> shapes_of(const UrdfCollision& collision);
  std::optional<std::variant<MeshParts, ShapeError>> parts_of(const UrdfMesh& mesh);
  void refuse(UrdfPlace place, const std::string& text);

  std::string urdf_;
  MeshFinder meshes_;
  const YamlNode& at_;
  ShapeReader& shapes_;
  PartLimits limits_;
  Diagnostics& diagnostics_;
};

}  // namespace clearance
