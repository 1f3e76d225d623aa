// Reads the objects one by one; `fixed` is read before the keys that it allows or forbids. The
// places of names are kept for later sections.
#include "config/cell/object_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "config/cell/ros_reader.hpp"
#include "config/scene/source_name.hpp"

namespace clearance {
namespace {

constexpr std::size_t kMaxNamedSources = 15;  // at most 16 sources are accepted: one place stays
                                              // for any other source

// Reads the limits on poses that arrive. A value that cannot be read is reported and stays as it
// is.
void read_input_limits(MapReader& map, const Quantities& quantities, ObjectDefaults& limits) {
  if (const YamlNode* speed = map.optional("max_speed")) {
    limits.max_speed = quantities.speed(*speed, "the largest speed of any point of the object")
                           .value_or(limits.max_speed);
  }
  if (const YamlNode* age = map.optional("age_limit_ms")) {
    limits.age_limit_ns =
        quantities.milliseconds(*age, "the age limit", kPositive).value_or(limits.age_limit_ns);
  }
  if (const YamlNode* frozen = map.optional("frozen_limit_ms")) {
    limits.frozen_limit_ns = quantities.milliseconds(*frozen, "the frozen limit", kPositive)
                                 .value_or(limits.frozen_limit_ns);
  }
  if (const YamlNode* jump = map.optional("may_jump")) {
    limits.may_jump = read_flag(*jump, quantities.diagnostics()).value_or(limits.may_jump);
  }
  if (const YamlNode* source = map.optional("source")) {
    limits.source = read_source(*source, quantities.diagnostics()).value_or(limits.source);
  }
}

// Reads one object of the list. A value that cannot be read is reported and keeps its default, so
// that one run reports every mistake.
class ObjectReader {
 public:
  ObjectReader(const ObjectDefaults& defaults, const Quantities& quantities, ShapeReader& shapes)
      : defaults_(defaults),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        shapes_(shapes) {}

  // Adds an object to `list`. If its name or a group cannot be read, it notes that the names in
  // `list` are incomplete.
  void read(const YamlNode& node, ObjectList& list);

 private:
  void read_groups(const YamlNode& node, Object& object, bool& names_known);
  void read_parts(MapReader& map, const YamlNode& node, Object& object);
  void read_part(const YamlNode& node, std::size_t place, Object& object);
  // A part that is refused is reported at `node`.
  void add_part(const YamlNode& node, NamedShape shape, const std::string& name, const Pose& pose,
                Object& object);
  void refuse_same_part_names(const YamlNode& node, std::size_t first, const Object& object);
  void read_motion(MapReader& map, Object& object);
  void forbid(MapReader& map, const std::string& key, const std::string& reason);

  const ObjectDefaults& defaults_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  ShapeReader& shapes_;
  double mesh_error_ = 0.0;  // of the object's meshes, the largest
};

// The order matters: `fixed` decides which of the other keys an object may have.
void ObjectReader::read(const YamlNode& node, ObjectList& list) {
  Object object;
  mesh_error_ = 0.0;
  MapReader map(node, "an object", diagnostics_);
  const YamlNode* name_node = map.required("name");
  const auto name =
      name_node == nullptr ? std::nullopt : read_name(*name_node, "an object's name", diagnostics_);
  object.name = name.value_or("");
  list.names_known = list.names_known && name.has_value();
  if (const YamlNode* groups = map.optional("groups")) {
    read_groups(*groups, object, list.names_known);
  }
  if (const YamlNode* fixed = map.optional("fixed")) {
    object.fixed = read_flag(*fixed, diagnostics_).value_or(false);
  }
  object.margin = defaults_.margin;
  if (const YamlNode* margin = map.optional("margin")) {
    object.margin = quantities_.length(*margin, "the margin", kNotNegative).value_or(0.0);
  }
  read_motion(map, object);
  read_parts(map, node, object);
  map.refuse_unknown_keys();
  if (mesh_error_ > 0.0) list.mesh_errors[object.name] = mesh_error_;
  list.objects.push_back(std::move(object));
}

// Reports a key that has no meaning here, and would silently be ignored. Asking for it makes it
// known, so that it is not reported again as unknown.
void ObjectReader::forbid(MapReader& map, const std::string& key, const std::string& reason) {
  if (const YamlNode* node = map.optional(key)) {
    diagnostics_.add(*node, fmt::format("found '{}' of {}", key, reason));
  }
}

// A fixed object has a pose; a moving one has limits on what arrives.
void ObjectReader::read_motion(MapReader& map, Object& object) {
  if (object.fixed) {
    if (const YamlNode* pose = map.optional("pose")) {
      object.world_from_object = quantities_.pose(*pose).value_or(Pose{});
    }
    object.max_speed = 0.0;
    for (const char* key :
         {"max_speed", "age_limit_ms", "frozen_limit_ms", "may_jump", "source", "frame"}) {
      forbid(map, key, "a fixed object; expected it of moving objects only");
    }
    return;
  }
  forbid(map, "pose",
         "a moving object; expected it of fixed objects (fixed: true) or of parts: a moving "
         "object's pose "
         "arrives on the topic of poses");
  ObjectDefaults own = defaults_;
  read_input_limits(map, quantities_, own);
  object.max_speed = own.max_speed;
  object.age_limit_ns = own.age_limit_ns;
  object.frozen_limit_ns = own.frozen_limit_ns;
  object.may_jump = own.may_jump;
  object.source = own.source;
  if (const YamlNode* frame = map.optional("frame"))
    object.frame = read_frame(*frame, diagnostics_).value_or("");
}

// A rule may name a group that could not be read. So, after a fault, `names_known` is set to false,
// and rules with unknown names are not reported.
void ObjectReader::read_groups(const YamlNode& node, Object& object, bool& names_known) {
  if (node.kind != YamlNode::Kind::kSequence) names_known = false;
  for (const YamlNode& item : read_list(node, "group names", diagnostics_)) {
    const auto group = read_name(item, "a group's name", diagnostics_);
    if (!group) {
      names_known = false;
    } else if (std::find(object.groups.begin(), object.groups.end(), *group) !=
               object.groups.end()) {
      diagnostics_.add(
          item, fmt::format("found the group '{}' again; expected it once an object", *group));
    } else {
      object.groups.push_back(*group);
    }
  }
}

// Reads `parts:`, or one shape in the object's own frame.
void ObjectReader::read_parts(MapReader& map, const YamlNode& node, Object& object) {
  const YamlNode* parts = map.optional("parts");
  if (parts == nullptr) {
    if (auto shape = shapes_.read(map, node)) {
      const std::string name = shape->kind;
      add_part(*shape->node, std::move(*shape), name, Pose{}, object);
    }
    return;
  }
  for (const std::string& kind : ShapeReader::kinds()) {
    forbid(map, kind, "an object that has 'parts'; expected it inside of one of them");
  }
  if (parts->kind == YamlNode::Kind::kSequence && parts->items.empty()) {
    diagnostics_.add(*parts, "found an empty list; expected at least one part");
  }
  std::size_t place = 0;
  for (const YamlNode& part : read_list(*parts, "parts", diagnostics_)) {
    read_part(part, place++, object);
  }
}

// Reports a part whose name another part of the object has. Only parts from `first` on are new;
// their name is at `node`.
void ObjectReader::refuse_same_part_names(const YamlNode& node, std::size_t first,
                                          const Object& object) {
  for (std::size_t i = first; i < object.parts.size(); ++i) {
    const std::string& name = object.parts[i].name;
    const auto same = [&](const Part& part) { return part.name == name; };
    if (std::count_if(object.parts.begin(), object.parts.end(), same) == 1) continue;
    diagnostics_.add(
        node, fmt::format("found the part name '{}' again; expected it once an object", name));
    return;
  }
}

// A part without a name is named after its shape and its place in the object: box0.
void ObjectReader::read_part(const YamlNode& node, std::size_t place, Object& object) {
  MapReader map(node, "a part", diagnostics_);
  const YamlNode* name_node = map.optional("name");
  const YamlNode* pose_node = map.optional("pose");
  auto shape = shapes_.read(map, node);
  map.refuse_unknown_keys();
  std::optional<std::string> name;
  if (name_node != nullptr) name = read_name(*name_node, "a part's name", diagnostics_);
  const Pose pose = pose_node == nullptr ? Pose{} : quantities_.pose(*pose_node).value_or(Pose{});
  if (!shape) return;
  const std::size_t first = object.parts.size();
  add_part(node, std::move(*shape), name.value_or(shape->kind + std::to_string(place)), pose,
           object);
  if (name) refuse_same_part_names(*name_node, first, object);
}

// A moving object must be bounded: the broad phase and the bounds between two ticks enclose it in a
// sphere.
void ObjectReader::add_part(const YamlNode& node, NamedShape shape, const std::string& name,
                            const Pose& pose, Object& object) {
  mesh_error_ = std::max(mesh_error_, shape.mesh_error);
  for (std::size_t i = 0; i < shape.shapes.size(); ++i) {
    if (!object.fixed && !shape.shapes[i].bounded()) {
      diagnostics_.add(
          node,
          fmt::format(
              "found an unbounded {} in a moving object; expected a bounded shape, or fixed: true",
              shape.kind));
      return;
    }
    object.parts.push_back(
        {name_of_part(name, i, shape.shapes.size()), std::move(shape.shapes[i]), pose});
  }
}

// Returns the place of an object's name, or of the object when it has none.
const YamlNode& name_place(const YamlNode& object) {
  for (const YamlEntry& entry : object.entries) {
    if (entry.key.text == "name") return entry.value;
  }
  return object;
}

}  // namespace

std::optional<std::string> read_source(const YamlNode& node, Diagnostics& diagnostics) {
  auto name = read_name(node, "a source's name", diagnostics);
  if (!name) return name;
  if (name->size() > kMaxSourceLength) {
    diagnostics.add(node, fmt::format("found a source's name of {} bytes; expected at most {}. A "
                                      "topic with a longer name is known by its last {} bytes",
                                      name->size(), kMaxSourceLength, kMaxSourceLength));
    return std::nullopt;
  }
  if (const std::string_view suffix = writer_suffix(*name); !suffix.empty()) {
    const std::string_view stem(name->data(), name->size() - suffix.size());
    diagnostics.add(
        node, fmt::format("found the source '{}'; expected a name that does not end in '#' and "
                          "a number. Such a number says in which order the writers of '{}' came, "
                          "and that may change at the next start. Give each writer another name "
                          "or topic",
                          *name, stem));
    return std::nullopt;
  }
  return name;
}

// The values have the same ranges as the keys of the objects.
ObjectDefaults read_defaults(const YamlNode& node, const Quantities& quantities) {
  ObjectDefaults defaults;
  MapReader map(node, "the defaults", quantities.diagnostics());
  read_part_limits(map, quantities, defaults.mesh_limits);
  if (const YamlNode* margin = map.optional("margin")) {
    defaults.margin = quantities.length(*margin, "the margin", kNotNegative).value_or(0.0);
  }
  read_input_limits(map, quantities, defaults);
  map.refuse_unknown_keys();
  return defaults;
}

ObjectList read_objects(const YamlNode& node, const ObjectDefaults& defaults,
                        const Quantities& quantities, ShapeReader& shapes) {
  Diagnostics& diagnostics = quantities.diagnostics();
  ObjectList list;
  ObjectReader reader(defaults, quantities, shapes);
  const std::vector<YamlNode>& items = read_list(node, "objects", diagnostics);
  if (node.kind == YamlNode::Kind::kSequence && items.empty()) {
    diagnostics.add(node, "found an empty list; expected at least one object");
  }
  // A list that is too long is reported at the first object over the limit. No object is read:
  // their shapes and pairs would take minutes and gigabytes for a cell that is refused.
  if (items.size() > kMaxObjects) {
    list.names_known = false;
    diagnostics.add(
        items[kMaxObjects],
        fmt::format("found {} objects; expected at most {}, which is what a report can carry",
                    items.size(), kMaxObjects));
    return list;
  }
  for (const YamlNode& item : items) {
    reader.read(item, list);
    list.places.push_back(&name_place(item));
  }
  if (node.kind != YamlNode::Kind::kSequence) list.names_known = false;
  return list;
}

// A repeated name is reported at its second place, with the line of the first.
void refuse_same_names(const ObjectList& list, Diagnostics& diagnostics) {
  std::map<std::string, const YamlNode*> first;
  for (std::size_t i = 0; i < list.objects.size(); ++i) {
    const std::string& name = list.objects[i].name;
    if (name.empty()) continue;
    if (const auto [same, is_new] = first.emplace(name, list.places[i]); !is_new) {
      diagnostics.add(
          *list.places[i],
          fmt::format("found the object name '{}' again; expected it once (first in line {})", name,
                      same->second->line));
    }
  }
}

void refuse_too_many_sources(const ObjectList& list, const std::vector<JointVariable>& joints,
                             const YamlNode* robots, Diagnostics& diagnostics) {
  std::set<std::string> sources;
  const auto add = [&](const std::string& source, const YamlNode& place) {
    if (source.empty() || !sources.insert(source).second) return;
    if (sources.size() != kMaxNamedSources + 1) return;
    diagnostics.add(place, fmt::format("found the source '{}' after {} others; expected at most {}",
                                       source, kMaxNamedSources, kMaxNamedSources));
  };
  for (std::size_t i = 0; i < list.objects.size(); ++i) {
    add(list.objects[i].source, *list.places[i]);
  }
  for (const JointVariable& joint : joints) add(joint.source, *robots);
}

}  // namespace clearance
