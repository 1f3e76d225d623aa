#include "config/cell/partner_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "config/scene/source_name.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {

bool is_partner_name(std::string_view name) noexcept {
  return !name.empty() && name.size() <= kMaxSourceLength &&
         std::ranges::all_of(name, [](char c) { return c > ' ' && c < 127; });
}

std::string read_partner(const YamlNode& node, Diagnostics& diagnostics) {
  const auto name = read_text(node, "the daemon's name among partners", diagnostics);
  if (!name || is_partner_name(*name)) return name.value_or("");
  diagnostics.add(node, fmt::format("found {}; expected a name of 1 to {} printable characters "
                                    "without blanks",
                                    describe(node), kMaxSourceLength));
  return {};
}

// In block style a key of the top level begins its line.
std::string without_partner(const YamlNode& document, const std::string& yaml) {
  const auto entry = std::ranges::find_if(
      document.entries, [](const YamlEntry& each) { return each.key.text == "partner"; });
  if (entry == document.entries.end()) return yaml;
  const bool is_a_line = entry->key.column == 1 && entry->value.line == entry->key.line;
  if (!is_a_line) return yaml;
  std::size_t begin = 0;
  for (int line = 1; line < entry->key.line; ++line) begin = yaml.find('\n', begin) + 1;
  return std::string(yaml).erase(begin, yaml.find('\n', begin) - begin + 1);
}

}  // namespace clearance
