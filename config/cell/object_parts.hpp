// Reads the parts of an object: one shape key, or a list of `parts`.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "config/cell/shape_reader.hpp"
#include "config/scene/scene.hpp"

namespace clearance {

class ObjectPartsReader {
 public:
  ObjectPartsReader(const Quantities& quantities, ShapeReader& shapes)
      : quantities_(quantities), diagnostics_(quantities.diagnostics()), shapes_(shapes) {}

  // Adds the parts that stand in this map, which is at `node`, to the object. Only fixed objects
  // may have unbounded ones. Returns the largest distance by which they exceed their meshes, m.
  double read(MapReader& map, const YamlNode& node, Object& object);

 private:
  void read_part(const YamlNode& node, std::size_t place, Object& object);
  // A part that is refused is reported at `node`.
  void add_part(const YamlNode& node, NamedShape&& shape, const std::string& name, const Pose& pose,
                Object& object);
  void refuse_same_part_names(const YamlNode& node, std::size_t first, const Object& object);

  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  ShapeReader& shapes_;
  double mesh_error_ = 0.0;  // of the object's meshes, the largest
};

// Reports a key that has no meaning here, and would silently be ignored. Asking for it makes it
// known, so that it is not reported again as unknown.
void forbid(MapReader& map, std::string_view key, const std::string& reason,
            Diagnostics& diagnostics);

}  // namespace clearance
