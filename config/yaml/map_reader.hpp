// Reads one YAML map key by key, and refuses the keys that no reader knows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "config/yaml/diagnostics.hpp"
#include "config/yaml/yaml_node.hpp"

namespace clearance {

// A reader asks for each key that it knows and calls refuse_unknown_keys() at the end. A node that
// is no map answers every request with nullptr, after one diagnostic.
class MapReader {
 public:
  // `what` names the map in messages: "a zone". Reports a node that is no map, and a key
  // that stands twice. The node and the diagnostics must outlive the reader.
  MapReader(const YamlNode& node, std::string what, Diagnostics& diagnostics);

  [[nodiscard]] bool is_map() const { return is_map_; }

  // Returns the value of a key, or nullptr. Asking makes the key known. It has to outlive this.
  [[nodiscard]] const YamlNode* optional(std::string_view key);
  [[nodiscard]] const YamlNode* required(std::string_view key);  // reports when it is missing

  // Call this after the last key was asked for.
  void refuse_unknown_keys();

 private:
  const YamlNode& node_;
  std::string what_;
  Diagnostics& diagnostics_;
  bool is_map_;
  std::vector<std::string_view> known_;
};

// Returns the items of a list; where there is none, an empty list after a diagnostic. `what`
// finishes "expected a list of ...".
[[nodiscard]] const std::vector<YamlNode>& read_list(const YamlNode& node, std::string_view what,
                                                     Diagnostics& diagnostics);

}  // namespace clearance
