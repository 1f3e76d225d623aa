// Writes YAML trees as a person would write a cell, in one form only: two trees with the same
// content give the same text.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "config/yaml/yaml_node.hpp"

namespace clearance {

// A value on one line. Keys stand in the order of config/KEYS.md, numbers are the shortest decimals
// that read back as the same double, and text is quoted only where it has to be.
[[nodiscard]] std::string line_of(const YamlNode& node);

// Lines of "- ITEM", indented by this many blanks, with a line end at the end. What is too long for
// one line becomes a block.
[[nodiscard]] std::string list_item(const YamlNode& item, std::size_t indent);

// Lines of "KEY: VALUE", likewise.
[[nodiscard]] std::string map_entry(const YamlNode& key, const YamlNode& value, std::size_t indent);

// Nodes for such trees.
[[nodiscard]] YamlNode text_node(std::string text);
[[nodiscard]] YamlNode texts_node(const std::vector<std::string>& texts);
[[nodiscard]] YamlNode number_node(double value);
[[nodiscard]] YamlNode flag_node(bool value);

// Returns the value of a key of a map, or nullptr.
[[nodiscard]] const YamlNode* find(const YamlNode& map, std::string_view key);
[[nodiscard]] YamlNode* find(YamlNode& map, std::string_view key);
// Sets or replaces the value of a key.
void set(YamlNode& map, const std::string& key, YamlNode value);
void erase(YamlNode& map, std::string_view key);

// Tells whether two trees have the same content, in the same order, wherever they stand.
[[nodiscard]] bool same_content(const YamlNode& a, const YamlNode& b);

}  // namespace clearance
