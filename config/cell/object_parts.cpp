#include "config/cell/object_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace clearance {

void forbid(MapReader& map, std::string_view key, const std::string& reason,
            Diagnostics& diagnostics) {
  if (const YamlNode* node = map.optional(key)) {
    diagnostics.add(*node, fmt::format("found '{}' of {}", key, reason));
  }
}

// Reads `parts:`, or one shape in the object's own frame.
double ObjectPartsReader::read(MapReader& map, const YamlNode& node, Object& object) {
  mesh_error_ = 0.0;
  const YamlNode* parts = map.optional("parts");
  if (parts == nullptr) {
    if (auto shape = shapes_.read(map, node))
      add_part(*shape->node, std::move(*shape), shape->kind, Pose{}, object);
    return mesh_error_;
  }
  for (const std::string& kind : ShapeReader::kinds()) {
    forbid(map, kind, "an object that has 'parts'; expected it inside of one of them",
           diagnostics_);
  }
  if (parts->kind == YamlNode::Kind::kSequence && parts->items.empty()) {
    diagnostics_.add(*parts, "found an empty list; expected at least one part");
  }
  std::size_t place = 0;
  for (const YamlNode& part : read_list(*parts, "parts", diagnostics_)) {
    read_part(part, place++, object);
  }
  return mesh_error_;
}

// Reports a part whose name another part of the object has. Only parts from `first` on are new;
// their name is at `node`.
void ObjectPartsReader::refuse_same_part_names(const YamlNode& node, std::size_t first,
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
void ObjectPartsReader::read_part(const YamlNode& node, std::size_t place, Object& object) {
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
// sphere. `shape` is a reference: a caller reads its kind for `name`, and arguments have any order.
void ObjectPartsReader::add_part(const YamlNode& node, NamedShape&& shape, const std::string& name,
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

}  // namespace clearance
