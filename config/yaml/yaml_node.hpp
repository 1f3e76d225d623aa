// A YAML document as a tree in which everything knows its line and column.
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace clearance {

struct YamlEntry;

// One value of the document. Which members are used depends on `kind`; the others stay empty.
struct YamlNode {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  Kind kind = Kind::kNull;
  int line = 1, column = 1;        // from 1, where the value starts
  std::string text;                // of a scalar
  bool quoted = false;             // "12" is text, 12 is a number
  std::vector<YamlNode> items;     // of a sequence
  std::vector<YamlEntry> entries;  // of a map: in the order of the file, the same key perhaps twice
};

// Keys are nodes too: a reader can then report a key that is no scalar at its place.
struct YamlEntry {
  YamlNode key;
  YamlNode value;
};

// The text is not one YAML document.
struct YamlFault {
  int line = 1, column = 1;
  std::string reason;  // what was found and what was expected
};

// Aliases (*name) are replaced by copies of what their anchors hold. Never throws.
[[nodiscard]] std::variant<YamlNode, YamlFault> parse_yaml(const std::string& text);

}  // namespace clearance
