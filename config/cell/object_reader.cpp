// Reads the objects one by one; `fixed` is read before the keys that it allows or forbids. The
// places of names are kept for later sections.
#include "config/cell/object_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <map>
#include <set>
#include <utility>

#include "config/cell/object_parts.hpp"
#include "config/cell/ros_reader.hpp"
#include "config/scene/source_name.hpp"
#include "config/text/spelling.hpp"

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
constexpr Range kMasses{.least = 0.0, .most = 1e6};  // kg

class ObjectReader {
 public:
  ObjectReader(const ObjectDefaults& defaults, const ObjectTemplates& templates,
               const Quantities& quantities, ShapeReader& shapes)
      : defaults_(defaults),
        templates_(templates),
        quantities_(quantities),
        diagnostics_(quantities.diagnostics()),
        parts_(quantities, shapes) {}

  // Adds an object to `list`. If its name or a group cannot be read, it notes that the names in
  // `list` are incomplete.
  void read(const YamlNode& node, ObjectList& list);

 private:
  void read_body(MapReader& map, const YamlNode& node, ObjectList& list, Object& object);
  void use_template(MapReader& map, const YamlNode& name_node, ObjectList& list, Object& object);
  void read_place(MapReader& map, Object& object);
  void read_limits(MapReader& map, Object& object);
  void read_attached(MapReader& map, Object& object);
  void forbid_all(MapReader& map, std::initializer_list<const char*> keys,
                  const std::string& reason);

  const ObjectDefaults& defaults_;
  const ObjectTemplates& templates_;
  const Quantities& quantities_;
  Diagnostics& diagnostics_;
  ObjectPartsReader parts_;
};

// Returns the place of an object's name, or of the object when it has none.
const YamlNode& name_place(const YamlNode& object) {
  for (const YamlEntry& entry : object.entries) {
    if (entry.key.text == "name") return entry.value;
  }
  return object;
}

// The order matters: `fixed` and `attached` decide which of the other keys an object may have.
void ObjectReader::read(const YamlNode& node, ObjectList& list) {
  Object object;
  MapReader map(node, "an object", diagnostics_);
  const YamlNode* name_node = map.required("name");
  const auto name =
      name_node == nullptr ? std::nullopt : read_name(*name_node, "an object's name", diagnostics_);
  object.name = name.value_or("");
  list.names_known = list.names_known && name.has_value();
  const YamlNode* fixed = map.optional("fixed");
  if (fixed != nullptr) object.fixed = read_flag(*fixed, diagnostics_).value_or(false);
  object.mass = read_mass(map, diagnostics_);
  if (const YamlNode* absent = map.optional("absent"))
    object.absent = read_flag(*absent, diagnostics_).value_or(false);
  const YamlNode* attached = map.optional("attached");
  if (attached != nullptr && fixed != nullptr) {
    diagnostics_.add(*fixed,
                     "found 'fixed' of an attached object; expected one of the two: an object that "
                     "is attached to a fixed one is fixed, too");
    object.fixed = false;
  }
  read_body(map, node, list, object);
  const YamlNode* max_speed = nullptr;
  if (attached != nullptr) {
    max_speed = map.optional("max_speed");
    read_attached(map, object);
  } else {
    read_place(map, object);
  }
  map.refuse_unknown_keys();
  if (attached != nullptr) {
    list.stated.push_back({std::move(object), &name_place(node), attached, max_speed});
    return;
  }
  list.objects.push_back(std::move(object));
  list.places.push_back(&name_place(node));
}

void ObjectReader::forbid_all(MapReader& map, std::initializer_list<const char*> keys,
                              const std::string& reason) {
  for (const char* key : keys) forbid(map, key, reason, diagnostics_);
}

// Reads groups, margin and shape, which a template may state as well.
void ObjectReader::read_body(MapReader& map, const YamlNode& node, ObjectList& list,
                             Object& object) {
  object.margin = defaults_.margin;
  const YamlNode* margin = map.optional("margin");
  const YamlNode* groups = map.optional("groups");
  if (groups != nullptr && !read_groups(*groups, object.groups, diagnostics_))
    list.names_known = false;
  if (const YamlNode* name = map.optional("template")) {
    use_template(map, *name, list, object);
  } else if (const double error = parts_.read(map, node, object); error > 0.0) {
    list.mesh_errors[object.name] = error;
  }
  if (margin != nullptr)
    object.margin = quantities_.length(*margin, "the margin", kNotNegative).value_or(0.0);
}

void ObjectReader::use_template(MapReader& map, const YamlNode& name_node, ObjectList& list,
                                Object& object) {
  for (const std::string& kind : ShapeReader::kinds())
    forbid(map, kind, "an object with a template, which states its shape", diagnostics_);
  forbid(map, "parts", "an object with a template, which states its shape", diagnostics_);
  const auto name = read_name(name_node, "a template's name", diagnostics_);
  if (!name) return;
  const auto found = templates_.find(*name);
  if (found == templates_.end()) {
    std::vector<std::string> names;
    for (const auto& [known, unused] : templates_) names.push_back(known);
    diagnostics_.add(name_node, fmt::format("found the unknown template '{}'; expected one under "
                                            "'templates'{}",
                                            *name, did_you_mean(*name, names)));
    list.names_known = false;  // its groups are missing
    return;
  }
  const ObjectTemplate& of = found->second;
  object.parts = of.parts;
  object.margin = of.margin.value_or(object.margin);
  for (const std::string& group : of.groups) {
    if (std::ranges::find(object.groups, group) == object.groups.end())
      object.groups.push_back(group);
  }
  if (of.mesh_error > 0.0) list.mesh_errors[object.name] = of.mesh_error;
  if (!object.fixed &&
      !std::ranges::all_of(object.parts, [](const Part& part) { return part.shape.bounded(); })) {
    diagnostics_.add(name_node,
                     fmt::format("found the unbounded template '{}' of a moving object; expected a "
                                 "bounded one, or fixed: true",
                                 *name));
  }
}

// A fixed object has a pose; a moving one has limits on what arrives.
void ObjectReader::read_place(MapReader& map, Object& object) {
  if (object.fixed) {
    if (const YamlNode* pose = map.optional("pose")) {
      object.world_from_object = quantities_.pose(*pose).value_or(Pose{});
    }
    object.max_speed = 0.0;
    forbid_all(map, {"max_speed", "age_limit_ms", "frozen_limit_ms", "may_jump", "source", "frame"},
               "a fixed object; expected it of moving objects only");
    return;
  }
  forbid_all(map, {"pose"},
             "a moving object; expected it of fixed objects (fixed: true), of parts or in "
             "'attached': a moving object's pose arrives on the topic of poses");
  read_limits(map, object);
}

void ObjectReader::read_limits(MapReader& map, Object& object) {
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

// The place of an attached object follows from its carrier, which attach_objects() finds later.
void ObjectReader::read_attached(MapReader& map, Object& object) {
  object.max_speed = defaults_.max_speed;
  if (const YamlNode* speed = map.optional("max_speed")) {
    object.max_speed = quantities_.speed(*speed, "the largest speed of any point of the object")
                           .value_or(object.max_speed);
  }
  object.age_limit_ns = defaults_.age_limit_ns;
  object.may_jump = defaults_.may_jump;
  forbid_all(map, {"pose"},
             "an attached object; expected it in 'attached', in the frame of the carrier");
  forbid_all(map, {"age_limit_ms", "frozen_limit_ms", "may_jump", "source", "frame"},
             "an attached object, whose place follows from its carrier; expected it there");
}

}  // namespace

double read_mass(MapReader& map, Diagnostics& diagnostics) {
  const YamlNode* const mass = map.optional("mass");
  if (mass == nullptr) return kInfinity;
  return read_number(*mass, kMasses, "a mass in kg", diagnostics).value_or(kInfinity);
}

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
                        const ObjectTemplates& templates, const Quantities& quantities,
                        ShapeReader& shapes) {
  Diagnostics& diagnostics = quantities.diagnostics();
  ObjectList list;
  ObjectReader reader(defaults, templates, quantities, shapes);
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
  for (const YamlNode& item : items) reader.read(item, list);
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

std::string note_on_sources(const ObjectList& list, std::span<const Robot> robots,
                            std::span<const JointVariable> joints) {
  std::set<std::string> sources;
  for (const Object& object : list.objects) {
    sources.insert(object.source);
    if (!object.frame.empty()) sources.insert("/tf");
  }
  for (const JointVariable& joint : joints) sources.insert(joint.source);
  for (const Robot& robot : robots) {
    sources.insert(robot.joint_states);
    if (!robot.base.frame.empty()) sources.insert("/tf:bases");
  }
  sources.erase("");
  constexpr std::size_t kHeard = kMaxNamedSources + 1;
  if (sources.size() <= kHeard) return {};
  return fmt::format(
      "the cell can need {} sources, but {} are heard at a time: the others are refused "
      "([source-refused]). Let robots share topics of joint states, or divide the cell into shares",
      sources.size(), kHeard);
}

}  // namespace clearance
