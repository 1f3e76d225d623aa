#include "config/yaml/yaml_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

// Longer values become blocks, bytes.
constexpr std::size_t kLine = 140;

// The keys of maps, in the order in which they are written. All others follow by the alphabet.
constexpr std::array<std::string_view, 48> kOrder = {
    "name",           "between",      "file",   "template",    "groups",      "fixed",
    "absent",         "attached",     "from",   "to",          "xyz",         "rpy",
    "quaternion",     "parts",        "box",    "sphere",      "capsule",     "prism",
    "polyhedron",     "half_space",   "mesh",   "ellipsoid",   "cylinder",    "cone",
    "truncated_cone", "normal",       "offset", "through",     "size",        "semi_axes",
    "lower_radius",   "upper_radius", "radius", "length",      "centre",      "rounding",
    "pose",           "touch",        "margin", "max_speed",   "publish",     "depth",
    "until",          "by",           "reason", "enter_below", "leave_above", "separation"};

std::pair<std::size_t, std::string_view> rank_of(const YamlEntry& entry) {
  const auto known = std::ranges::find(kOrder, std::string_view(entry.key.text));
  return {static_cast<std::size_t>(known - kOrder.begin()), entry.key.text};
}

std::vector<const YamlEntry*> in_order(const YamlNode& map) {
  std::vector<const YamlEntry*> entries;
  for (const YamlEntry& entry : map.entries) entries.push_back(&entry);
  std::ranges::stable_sort(entries, {}, [](const YamlEntry* entry) { return rank_of(*entry); });
  return entries;
}

// Text that needs no quotes anywhere: not a number, no flag, no indicator of YAML.
bool is_plain(const std::string& text) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  if (text.empty() || !(letter(text.front()) || text.front() == '/') || text.back() == ' ')
    return false;
  const bool safe = std::ranges::all_of(text, [&](char c) {
    return letter(c) || (c >= '0' && c <= '9') || c == '.' || c == '/' || c == '-' || c == ' ';
  });
  YamlNode node;
  node.kind = YamlNode::Kind::kScalar;
  node.text = text;
  return safe && scalar_type(node) == ScalarType::kText && text != "null" && text != "Null" &&
         text != "NULL";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20 || code == 0x7f) {
      out += fmt::format("\\x{:02x}", code);
    } else {
      out += c;
    }
  }
  return out + '"';
}

// A whole number that a double would round, such as a time in ns.
std::optional<std::int64_t> large_integer(const char* begin, const char* end) {
  constexpr std::int64_t kExact = std::int64_t{1} << 53;
  std::int64_t value = 0;
  const auto result = std::from_chars(begin, end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value > kExact || value < -kExact ? std::optional(value) : std::nullopt;
}

std::string scalar_text(const YamlNode& node) {
  switch (scalar_type(node)) {
    case ScalarType::kFlag:
      return node.text.front() == 't' || node.text.front() == 'T' ? "true" : "false";
    case ScalarType::kNumber: {
      const char* begin = node.text.data() + (node.text.front() == '+' ? 1 : 0);
      const char* end = node.text.data() + node.text.size();
      if (const auto integer = large_integer(begin, end)) return fmt::format("{}", *integer);
      double value = 0.0;
      const auto result = std::from_chars(begin, end, value);
      const bool read = result.ec == std::errc() && result.ptr == end && std::isfinite(value);
      return read ? fmt::format("{}", value) : node.text;
    }
    case ScalarType::kText:
      break;
  }
  return is_plain(node.text) ? node.text : quoted(node.text);
}

void add_line(const YamlNode& node, std::string& out) {
  const char* separator = "";
  switch (node.kind) {
    case YamlNode::Kind::kNull:
      out += "null";
      return;
    case YamlNode::Kind::kScalar:
      out += scalar_text(node);
      return;
    case YamlNode::Kind::kSequence:
      out += '[';
      for (const YamlNode& item : node.items) {
        out += std::exchange(separator, ", ");
        add_line(item, out);
      }
      out += ']';
      return;
    case YamlNode::Kind::kMap:
      out += '{';
      for (const YamlEntry* entry : in_order(node)) {
        out += std::exchange(separator, ", ");
        add_line(entry->key, out);
        out += ": ";
        add_line(entry->value, out);
      }
      out += '}';
      return;
  }
}

// Adds the lines of a block. The first line has been indented already.
void add_block(const YamlNode& node, std::size_t indent, std::string& out) {
  bool is_first = true;
  const auto start_line = [&] {
    if (!std::exchange(is_first, false)) out.append(indent, ' ');
  };
  if (node.kind == YamlNode::Kind::kSequence) {
    for (const YamlNode& item : node.items) {
      start_line();
      out += list_item(item, indent).substr(indent);
    }
  } else {
    for (const YamlEntry* entry : in_order(node)) {
      start_line();
      out += map_entry(entry->key, entry->value, indent).substr(indent);
    }
  }
}

bool is_empty(const YamlNode& node) { return node.items.empty() && node.entries.empty(); }

YamlNode scalar(std::string text, bool is_quoted) {
  YamlNode node;
  node.kind = YamlNode::Kind::kScalar;
  node.text = std::move(text);
  node.quoted = is_quoted;
  return node;
}

}  // namespace

std::string line_of(const YamlNode& node) {
  std::string line;
  add_line(node, line);
  return line;
}

std::string list_item(const YamlNode& item, std::size_t indent) {
  std::string out(indent, ' ');
  out += "- ";
  const std::string line = line_of(item);
  if (out.size() + line.size() <= kLine || is_empty(item)) return out + line + '\n';
  add_block(item, indent + 2, out);
  return out;
}

std::string map_entry(const YamlNode& key, const YamlNode& value, std::size_t indent) {
  std::string out(indent, ' ');
  out += line_of(key) + ':';
  const std::string line = line_of(value);
  if (out.size() + 1 + line.size() <= kLine || is_empty(value)) return out + ' ' + line + '\n';
  out += '\n';
  out.append(indent + 2, ' ');
  add_block(value, indent + 2, out);
  return out;
}

YamlNode text_node(std::string text) { return scalar(std::move(text), true); }

YamlNode texts_node(const std::vector<std::string>& texts) {
  YamlNode list;
  list.kind = YamlNode::Kind::kSequence;
  for (const std::string& text : texts) list.items.push_back(text_node(text));
  return list;
}

YamlNode number_node(double value) {
  return scalar(fmt::format("{}", value == 0.0 ? 0.0 : value), false);
}
YamlNode flag_node(bool value) { return scalar(value ? "true" : "false", false); }

const YamlNode* find(const YamlNode& map, std::string_view key) {
  const auto found = std::ranges::find_if(map.entries, [&](const YamlEntry& entry) {
    return entry.key.kind == YamlNode::Kind::kScalar && entry.key.text == key;
  });
  return found == map.entries.end() ? nullptr : &found->value;
}

YamlNode* find(YamlNode& map, std::string_view key) {
  return const_cast<YamlNode*>(find(std::as_const(map), key));
}

void set(YamlNode& map, const std::string& key, YamlNode value) {
  map.kind = YamlNode::Kind::kMap;
  if (YamlNode* found = find(map, key)) {
    *found = std::move(value);
  } else {
    map.entries.push_back({scalar(key, false), std::move(value)});
  }
}

void erase(YamlNode& map, std::string_view key) {
  std::erase_if(map.entries, [&](const YamlEntry& entry) {
    return entry.key.kind == YamlNode::Kind::kScalar && entry.key.text == key;
  });
}

bool same_content(const YamlNode& a, const YamlNode& b) {
  return a.kind == b.kind && a.text == b.text && a.quoted == b.quoted &&
         std::ranges::equal(a.items, b.items, same_content) &&
         std::ranges::equal(a.entries, b.entries, [](const YamlEntry& x, const YamlEntry& y) {
           return same_content(x.key, y.key) && same_content(x.value, y.value);
         });
}

}  // namespace clearance
