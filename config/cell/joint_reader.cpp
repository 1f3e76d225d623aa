#include "config/cell/joint_reader.hpp"

#include <fmt/format.h>

#include "config/cell/object_reader.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// No joint is faster, in rad/s or m/s.
constexpr Range kVelocities{.least = 1e-9, .most = 1e6};

void read_joint(const YamlNode& node, const Quantities& quantities,
                const std::vector<JointVariable*>& of_joint) {
  MapReader map(node, "a joint", quantities.diagnostics());
  if (const YamlNode* age = map.optional("age_limit_ms")) {
    if (const auto limit = quantities.milliseconds(*age, "the age limit", kPositive)) {
      for (JointVariable* variable : of_joint) variable->age_limit_ns = *limit;
    }
  }
  if (const YamlNode* source = map.optional("source")) {
    if (const auto name = read_source(*source, quantities.diagnostics())) {
      for (JointVariable* variable : of_joint) variable->source = *name;
    }
  }
  if (const YamlNode* velocity = map.optional("velocity")) {
    const auto limit = read_number(*velocity, kVelocities, "a velocity limit in rad/s or m/s",
                                   quantities.diagnostics());
    for (JointVariable* variable : of_joint) {
      variable->max_speed = limit.value_or(variable->max_speed);
    }
  }
  map.refuse_unknown_keys();
}

}  // namespace

// A joint with several positions has as many variables: NAME/x and so on.
void read_joints(const YamlNode& node, const std::string& prefix, const Quantities& quantities,
                 std::vector<JointVariable>& variables) {
  Diagnostics& diagnostics = quantities.diagnostics();
  if (node.kind != YamlNode::Kind::kMap) {
    diagnostics.add(
        node, fmt::format("found {}; expected joints and what is said of them: {{NAME: {{...}}}}",
                          describe(node)));
  }
  std::vector<std::string> names;
  for (const JointVariable& variable : variables) {
    names.push_back(variable.name.substr(prefix.size(), variable.name.find('/') - prefix.size()));
  }
  for (const YamlEntry& entry : node.entries) {
    const auto name = read_name(entry.key, "a joint's name", diagnostics);
    if (!name) continue;
    std::vector<JointVariable*> of_joint;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == *name) of_joint.push_back(&variables[i]);
    }
    if (of_joint.empty()) {
      diagnostics.add(entry.key,
                      fmt::format("found the unknown joint '{}'; expected one that moves and does "
                                  "not mimic another, by its name in the URDF{}",
                                  *name, did_you_mean(*name, names)));
    } else {
      read_joint(entry.value, quantities, of_joint);
    }
  }
}

}  // namespace clearance
