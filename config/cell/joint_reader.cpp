#include "config/cell/joint_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/cell/object_reader.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/diagnostics.hpp"
#include "config/yaml/map_reader.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// No joint is faster, in rad/s or m/s.
constexpr Range kVelocities{.least = 1e-9, .most = 1e6};
constexpr Range kPositions{.least = -1e6, .most = 1e6};

void read_limits(const YamlNode& node, Diagnostics& diagnostics,
                 const std::vector<JointVariable*>& of_joint) {
  const std::string_view expected = "the lower and the upper limit of a joint in rad or m";
  const std::vector<YamlNode>& items = read_list(node, std::string(expected), diagnostics);
  if (items.size() != 2 || of_joint.size() != 1) {
    diagnostics.add(node,
                    fmt::format("found {} limits of a joint with {}; expected {}: [-1.5, 1.5]",
                                items.size(), counted(of_joint.size(), "position"), expected));
    return;
  }
  const auto lower = read_number(items[0], kPositions, "a lower limit in rad or m", diagnostics);
  const auto upper = read_number(items[1], kPositions, "an upper limit in rad or m", diagnostics);
  if (!lower || !upper) return;
  if (!(*lower <= *upper)) {
    diagnostics.add(node, fmt::format("found limits from {} to {}; expected the lower one first",
                                      *lower, *upper));
    return;
  }
  of_joint.front()->lower = *lower;
  of_joint.front()->upper = *upper;
}

void read_position(const YamlNode& node, Diagnostics& diagnostics,
                   const std::vector<JointVariable*>& of_joint) {
  const auto position = read_number(node, kPositions, "a position in rad or m", diagnostics);
  if (position && of_joint.size() == 1) {
    of_joint.front()->held = *position;
  } else if (position) {
    diagnostics.add(node, fmt::format("found the position of a joint with {}; expected it of a "
                                      "joint with one",
                                      counted(of_joint.size(), "position")));
  }
}

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
  if (const YamlNode* frozen = map.optional("frozen_limit_ms")) {
    if (const auto limit = quantities.milliseconds(*frozen, "the frozen limit", kPositive)) {
      for (JointVariable* variable : of_joint) variable->frozen_limit_ns = *limit;
    }
  }
  if (const YamlNode* limits = map.optional("limits"))
    read_limits(*limits, quantities.diagnostics(), of_joint);
  if (const YamlNode* position = map.optional("position"))
    read_position(*position, quantities.diagnostics(), of_joint);
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

void refuse_positions_outside(const YamlNode& node, std::span<const JointVariable> variables,
                              Diagnostics& diagnostics) {
  for (const JointVariable& variable : variables) {
    const double beyond = std::max(variable.lower - variable.held, variable.held - variable.upper);
    if (!variable.is_held() || beyond <= variable.limit_tolerance) continue;
    diagnostics.add(node,
                    fmt::format("found the position {} of '{}'; expected one within its "
                                "limits, from {} to {}",
                                variable.held, variable.name, variable.lower, variable.upper));
  }
}

}  // namespace clearance
