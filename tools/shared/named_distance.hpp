// A distance on the command line with the pairs that it is of: "A,B=0.05" or "ZONE=0.05".
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <variant>

namespace clearance {

struct NamedDistance {
  std::string a, b;              // objects or groups; `b` is empty for a zone
  std::optional<double> metres;  // none: it is not stated
};

// Returns what was read, or what is wrong, as the end of a sentence.
[[nodiscard]] inline std::variant<NamedDistance, std::string> read_named_distance(
    const std::string& text) {
  NamedDistance read;
  std::string names = text;
  if (const std::size_t at = text.rfind('='); at != std::string::npos) {
    const char* const end = text.data() + text.size();
    double stated = 0.0;
    if (std::from_chars(text.data() + at + 1, end, stated).ptr != end || at + 1 == text.size() ||
        !std::isfinite(stated)) {
      return fmt::format("found '{}' after '=' in '{}'; expected a distance, m",
                         text.substr(at + 1), text);
    }
    read.metres = stated;
    names.resize(at);
  }
  const std::size_t comma = names.find(',');
  read.a = names.substr(0, comma);
  if (comma != std::string::npos) read.b = names.substr(comma + 1);
  if (read.a.empty() || (comma != std::string::npos && read.b.empty()))
    return fmt::format("found '{}'; expected two objects or groups, A,B, or a zone", text);
  return read;
}

}  // namespace clearance
