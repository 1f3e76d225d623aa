#include "config/edit/object_users.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "config/edit/touched_entry.hpp"
#include "config/yaml/yaml_writer.hpp"

namespace clearance {

std::string text_of(const YamlNode* node) {
  return node != nullptr && node->kind == YamlNode::Kind::kScalar ? node->text : "";
}
std::string name_of(const YamlNode& entry) { return text_of(find(entry, "name")); }

// The two sides of `between`, in alphabetic order.
std::pair<std::string, std::string> sides_of(const YamlNode& entry) {
  const YamlNode* between = find(entry, "between");
  if (between == nullptr || between->items.size() != 2) return {};
  return std::minmax(between->items[0].text, between->items[1].text);
}

std::vector<std::string> users_of(const std::string& name, const CellDocument& document) {
  std::vector<std::string> users;
  const auto add = [&](std::string_view list, const YamlNode& entry, std::size_t place) {
    users.push_back(fmt::format("{}[{}]", list, entry_label(entry, place)));
  };
  for (const std::string_view list : {"pairs", "allowed_collisions", "zones", "contacts"}) {
    const std::vector<YamlNode>& items = document.items(list);
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto [a, b] = sides_of(items[i]);
      if (a == name || b == name) add(list, items[i], i);
    }
  }
  const std::vector<YamlNode>& objects = document.items("objects");
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const YamlNode* attached = find(objects[i], "attached");
    if (attached == nullptr || name_of(objects[i]) == name) continue;
    const YamlNode* touch = find(*attached, "touch");
    const bool touches =
        touch != nullptr &&
        std::ranges::find(touch->items, name, &YamlNode::text) != touch->items.end();
    if (text_of(find(*attached, "to")) == name || touches) add("objects", objects[i], i);
  }
  if (const YamlNode* robots = find(document.tree(), "robots")) {
    for (std::size_t i = 0; i < robots->items.size(); ++i) {
      const YamlNode* base = find(robots->items[i], "base");
      const YamlNode* attached = find(robots->items[i], "attached");
      if ((base != nullptr && text_of(find(*base, "on")) == name) ||
          (attached != nullptr && text_of(find(*attached, "to")) == name))
        add("robots", robots->items[i], i);
    }
  }
  return users;
}

}  // namespace clearance
