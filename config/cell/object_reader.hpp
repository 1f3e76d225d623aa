// Reads the objects of a cell file.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "config/cell/object_template.hpp"
#include "config/cell/pair_key.hpp"
#include "config/cell/shape_reader.hpp"
#include "config/moveit/collision_matrix.hpp"
#include "config/scene/scene.hpp"
#include "config/yaml/quantities.hpp"

namespace clearance {

// The `defaults:` section: values of objects that do not state their own.
struct ObjectDefaults {
  double margin = 0.0;           // m
  double max_speed = kInfinity;  // m/s
  std::int64_t age_limit_ns = 20'000'000;
  std::int64_t frozen_limit_ns = 0;  // none
  bool may_jump = false;
  std::string source;  // any
  PartLimits mesh_limits;
};

// Reads `mass`, kg; infinity: it is not stated.
[[nodiscard]] double read_mass(MapReader& map, Diagnostics& diagnostics);

// Reads the name of a source, at most as long as a batch can carry; returns nothing after a
// diagnostic.
[[nodiscard]] std::optional<std::string> read_source(const YamlNode& node,
                                                     Diagnostics& diagnostics);

// An object with `attached`, before its carrier is known.
struct StatedAttachment {
  Object object;
  const YamlNode* place;      // of its name
  const YamlNode* attached;   // the value of that key
  const YamlNode* max_speed;  // null: not stated
};

// Objects with their places in the file, at which later sections report mistakes.
struct ObjectList {
  std::vector<Object> objects;
  std::vector<const YamlNode*> places;        // of each object's name
  std::map<std::string, double> mesh_errors;  // of those with meshes (cell_file.hpp)
  std::vector<StatedAttachment> stated;       // in the order of the file; not among `objects` yet
  std::list<YamlNode> generated;              // nodes that are in no file
  // Collision matrices of planning scenes, with the lines of the scenes.
  std::vector<std::pair<moveit::CollisionMatrix, int>> matrices;
  // attach_objects() (attachment_reader.hpp) makes the rest. An object that is attached to a link
  // without shapes has no entry in `attachments`.
  std::vector<Attachment> attachments;  // ascending by object, a carrier before what it carries
  std::vector<PairKey> left_out;  // ascending: of attached objects, and `rigid`; never watched
  std::vector<PairKey> touching;  // those of them that may touch by a rule of `touch`
  std::vector<PairKey> rigid =
      {};  // ascending: of what stands on one body, but for links of one robot
  // The names of robots with groups of their own: a rule may name them, and none has to.
  std::set<std::string> optional_groups = {};
  bool names_known = true;  // false: a name or group could not be read, so others may seem unknown
};

// Reads `defaults:`. A value that cannot be read is reported and keeps its default.
[[nodiscard]] ObjectDefaults read_defaults(const YamlNode& node, const Quantities& quantities);

inline constexpr std::size_t kMaxObjects = 4096;  // idl/clearance.idl

// Reads `objects:`, at most kMaxObjects. An object with a mistake stays in the list, since the ids
// of all that follow are places in it. Attached objects are only stated.
[[nodiscard]] ObjectList read_objects(const YamlNode& node, const ObjectDefaults& defaults,
                                      const ObjectTemplates& templates,
                                      const Quantities& quantities, ShapeReader& shapes);

// No two objects may have one name, links of robots included.
void refuse_same_names(const ObjectList& list, Diagnostics& diagnostics);

// Objects and the joints of `robots`, which may be null, may not name more sources than are
// accepted.
void refuse_too_many_sources(const ObjectList& list, const std::vector<JointVariable>& joints,
                             const YamlNode* robots, Diagnostics& diagnostics);

// A sentence for a person if the cell can need more sources than are heard at a time: named ones,
// topics of joint states, and tf for objects and for bases. Else empty.
[[nodiscard]] std::string note_on_sources(const ObjectList& list, std::span<const Robot> robots,
                                          std::span<const JointVariable> joints);

}  // namespace clearance
