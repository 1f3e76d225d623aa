#include "config/cell/object_template.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/cell/object_parts.hpp"

namespace clearance {

// The caller leaves out checks of unknown names after a fault, since a rule may name a group that
// could not be read.
bool read_groups(const YamlNode& node, std::vector<std::string>& groups, Diagnostics& diagnostics) {
  bool all_known = node.kind == YamlNode::Kind::kSequence;
  for (const YamlNode& item : read_list(node, "group names", diagnostics)) {
    const auto group = read_name(item, "a group's name", diagnostics);
    if (!group) {
      all_known = false;
    } else if (std::ranges::find(groups, *group) != groups.end()) {
      diagnostics.add(
          item, fmt::format("found the group '{}' again; expected it once an object", *group));
    } else {
      groups.push_back(*group);
    }
  }
  return all_known;
}

// Whether an object may be unbounded is checked where it uses the template.
ObjectTemplates read_templates(const YamlNode& node, const Quantities& quantities,
                               ShapeReader& shapes) {
  Diagnostics& diagnostics = quantities.diagnostics();
  ObjectTemplates templates;
  ObjectPartsReader parts(quantities, shapes);
  for (const YamlNode& item : read_list(node, "templates", diagnostics)) {
    MapReader map(item, "a template", diagnostics);
    const YamlNode* name_node = map.required("name");
    const YamlNode* groups = map.optional("groups");
    const YamlNode* margin = map.optional("margin");
    ObjectTemplate made;
    if (groups != nullptr) read_groups(*groups, made.groups, diagnostics);
    if (margin != nullptr) made.margin = quantities.length(*margin, "the margin", kNotNegative);
    Object body;
    body.fixed = true;
    made.mesh_error = parts.read(map, item, body);
    made.parts = std::move(body.parts);
    map.refuse_unknown_keys();
    if (name_node == nullptr) continue;
    const auto name = read_name(*name_node, "a template's name", diagnostics);
    if (name && !templates.emplace(*name, std::move(made)).second) {
      diagnostics.add(*name_node,
                      fmt::format("found the template '{}' again; expected it once", *name));
    }
  }
  return templates;
}

}  // namespace clearance
