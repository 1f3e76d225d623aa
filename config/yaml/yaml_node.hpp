// A YAML document as a tree in which each value knows its line and column.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace clearance {

struct YamlEntry;

// One value of the document. `kind` decides which members are used; the others stay empty.
struct YamlNode {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  Kind kind = Kind::kNull;
  int line = 1, column = 1;        // from 1: the start of the value
  std::string text;                // of a scalar
  bool quoted = false;             // "12" is text, 12 is a number
  std::vector<YamlNode> items;     // of a sequence
  std::vector<YamlEntry> entries;  // of a map, in the order of the file; a key may stand twice
};

// Keys are nodes too: a reader can report a key that is no scalar at its place.
struct YamlEntry {
  YamlNode key;
  YamlNode value;
};

// Appends what the value says, wherever it stands in the document. Different values append
// different bytes.
void add_content(const YamlNode& node, std::string& bytes);

// The text is not one YAML document.
struct YamlFault {
  int line = 1, column = 1;
  std::string reason;  // what was found and what was expected
};

// Aliases (*name) are replaced by copies of the values at their anchors. Never throws.
[[nodiscard]] std::variant<YamlNode, YamlFault> parse_yaml(const std::string& text);

}  // namespace clearance
