// One value of a cell file that is neither list nor map: a number, a truth value, or a text.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "config/yaml/yaml_node.hpp"

namespace clearance {

class Diagnostics;

// The types of scalars that a cell file uses. null is a kind of YamlNode; integers are numbers.
enum class ScalarType { kNumber, kFlag, kText };

// Returns the type of an unquoted scalar by the core schema of YAML 1.2; a quoted one is always
// text.
[[nodiscard]] ScalarType scalar_type(const YamlNode& scalar);

// Describes a node for messages: "nothing", "the number 12", "the text 'abc'", "a list of 3", "a
// map".
[[nodiscard]] std::string describe(const YamlNode& node);

// The numbers that are accepted.
struct Range {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool above_least = false;  // `least` itself is not accepted
};
// The ranges that most quantities have.
inline constexpr Range kPositive{.least = 0.0, .above_least = true};
inline constexpr Range kNotNegative{.least = 0.0};

// Each returns nothing after a diagnostic. `what` finishes "expected ...": "a length in mm".
[[nodiscard]] std::optional<double> read_number(const YamlNode& node, const Range& range,
                                                const std::string& what, Diagnostics& diagnostics);
[[nodiscard]] std::optional<std::int64_t> read_integer(const YamlNode& node, std::int64_t least,
                                                       std::int64_t most, const std::string& what,
                                                       Diagnostics& diagnostics);
[[nodiscard]] std::optional<bool> read_flag(const YamlNode& node, Diagnostics& diagnostics);
[[nodiscard]] std::optional<std::string> read_text(const YamlNode& node, const std::string& what,
                                                   Diagnostics& diagnostics);

// Reads a name that people and CSV files can hold: 1 to 64 bytes, no control characters, commas,
// quotes, nor blanks at its ends.
[[nodiscard]] std::optional<std::string> read_name(const YamlNode& node, const std::string& what,
                                                   Diagnostics& diagnostics);

}  // namespace clearance
