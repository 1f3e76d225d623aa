// Reads the objects of a cell file.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "config/cell/shape_reader.hpp"
#include "config/scene/scene.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// The values of objects that do not state their own: the `defaults:` section.
struct ObjectDefaults {
  double margin = 0.0;           // m
  double max_speed = kInfinity;  // m/s
  std::int64_t age_limit_ns = 20'000'000;
  std::int64_t frozen_limit_ns = 0;  // none
  bool may_jump = false;
  std::string source;  // any
  PartLimits mesh_limits;
};

// The name of a source, at most as long as a batch can carry; nothing after a diagnostic.
[[nodiscard]] std::optional<std::string> read_source(const YamlNode& node,
                                                     Diagnostics& diagnostics);

// Objects with what they were read from, so that later sections can report mistakes at their
// places.
struct ObjectList {
  std::vector<Object> objects;
  std::vector<const YamlNode*> places;        // of each object: where its name stands
  std::map<std::string, double> mesh_errors;  // of those with meshes (cell_file.hpp)
  bool names_known = true;  // false: some name or group could not be read; others may seem unknown
};

// Reads `defaults:`. A value that cannot be read is reported and keeps its default.
[[nodiscard]] ObjectDefaults read_defaults(const YamlNode& node, const Quantities& quantities);

inline constexpr std::size_t kMaxObjects = 4096;  // idl/clearance.idl

// Reads `objects:`, at most kMaxObjects. An object with a mistake stays in the list, since the ids
// of all that follow are places in it.
[[nodiscard]] ObjectList read_objects(const YamlNode& node, const ObjectDefaults& defaults,
                                      const Quantities& quantities, ShapeReader& shapes);

// Of all objects, those that are links of robots included: no two may have one name.
void refuse_same_names(const ObjectList& list, Diagnostics& diagnostics);

// Nor may they name more sources than are heard, together with the joints of `robots`, which may be
// null.
void refuse_too_many_sources(const ObjectList& list, const std::vector<JointVariable>& joints,
                             const YamlNode* robots, Diagnostics& diagnostics);

}  // namespace clearance
