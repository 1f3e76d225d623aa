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

// Every fault of a robot's description, where the cell names the file.
void refuse_robot(const YamlNode& at, const UrdfFaults& faults, Diagnostics& diagnostics);

// Of a mesh the parts that contain it: never smaller than the link.
class LinkParts {
 public:
  // `files` are those of the URDF, which the cell names at `urdf_node`; mistakes are reported
  // there.
  LinkParts(RobotFiles files, const YamlNode& urdf_node, ShapeReader& shapes,
            const PartLimits& limits, Diagnostics& diagnostics)
      : files_(std::move(files)),
        at_(urdf_node),
        shapes_(shapes),
        limits_(limits),
        diagnostics_(diagnostics) {}

  // Parts are called after their kind and their place in the link, as those of other objects are;
  // without those that were reported. Returns how far those of meshes reach beyond these, m.
  double add(const UrdfLink& link, Object& object);

 private:
  std::optional<std::variant<MeshParts, ShapeError>> shapes_of(const UrdfCollision& collision);
  std::optional<std::variant<MeshParts, ShapeError>> parts_of(const UrdfMesh& mesh);

  RobotFiles files_;
  const YamlNode& at_;
  ShapeReader& shapes_;
  PartLimits limits_;
  Diagnostics& diagnostics_;
};

}  // namespace clearance
