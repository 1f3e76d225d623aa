#include "config/cell/person_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/scene/body_id.hpp"
#include "config/urdf/person.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {

// A stature in a wrong unit would make a person without girth, or one as large as the cell.
PersonKeys read_person(const YamlNode& node, const std::string& name, MapReader& robot,
                       const Quantities& quantities) {
  Diagnostics& diagnostics = quantities.diagnostics();
  for (const char* key :
       {"srdf", "srdf_with", "prefix", "attached", "visual_as_collision", "joints", "stopping"}) {
    if (const YamlNode* other = robot.optional(key))
      diagnostics.add(*other, fmt::format("found '{}' of a person; expected it of a robot", key));
  }
  PersonKeys keys;
  MapReader map(node, "a person", diagnostics);
  if (const YamlNode* stature = map.required("stature")) {
    keys.stature = quantities.length(*stature, "the stature", kPositive).value_or(kLeastStature);
    if (!(keys.stature >= kLeastStature && keys.stature <= kMostStature)) {
      diagnostics.add(*stature, fmt::format("found a stature of {} m; expected {} to {} m, in the "
                                            "cell's unit of length",
                                            keys.stature, kLeastStature, kMostStature));
      keys.stature = kLeastStature;
    }
  }
  if (const YamlNode* error = map.required("error"))
    keys.error = quantities.length(*error, "the error of limbs", kNotNegative).value_or(0.0);
  keys.id = name;
  if (const YamlNode* id = map.optional("id")) {
    const auto text = read_text(*id, "the id of a body in /humans/bodies, or ''", diagnostics);
    keys.id = text.value_or("");
    if (!keys.id.empty() && !is_body_id(keys.id)) {
      diagnostics.add(*id, fmt::format("found the id '{}'; expected up to {} letters, digits and "
                                       "'_', as in /humans/bodies/tracked, or '' for no body",
                                       keys.id, kLongestBodyId));
    }
  }
  map.refuse_unknown_keys();
  return keys;
}

}  // namespace clearance
