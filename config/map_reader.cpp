#include "config/map_reader.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "config/spelling.hpp"

namespace clearance {

MapReader::MapReader(const YamlNode& node, std::string what, Diagnostics& complaints)
    : node_(node),
      what_(std::move(what)),
      complaints_(complaints),
      is_map_(node.kind == YamlNode::Kind::kMap) {
  if (!is_map_) {
    complaints_.add(node, "found " + describe(node) + "; expected " + what_ + " (a map)");
    return;
  }
  std::map<std::string, const YamlNode*> first;
  for (const YamlEntry& entry : node.entries) {
    if (entry.key.kind != YamlNode::Kind::kScalar) {
      complaints_.add(entry.key, "found " + describe(entry.key) + " as a key; expected a word");
    } else if (const auto [same, is_new] = first.emplace(entry.key.text, &entry.key); !is_new) {
      complaints_.add(entry.key, "found the key '" + entry.key.text +
                                     "' again; expected it once in " + what_ + " (first in line " +
                                     std::to_string(same->second->line) + ")");
    }
  }
}

const YamlNode* MapReader::optional(const std::string& key) {
  known_.push_back(key);
  for (const YamlEntry& entry : node_.entries) {
    if (entry.key.kind == YamlNode::Kind::kScalar && entry.key.text == key) return &entry.value;
  }
  return nullptr;
}

const YamlNode* MapReader::required(const std::string& key) {
  const YamlNode* value = optional(key);
  if (value == nullptr && is_map_) {
    complaints_.add(node_, "found no key '" + key + "'; expected it in " + what_);
  }
  return value;
}

void MapReader::refuse_unknown_keys() {
  for (const YamlEntry& entry : node_.entries) {
    if (entry.key.kind != YamlNode::Kind::kScalar) continue;
    if (std::find(known_.begin(), known_.end(), entry.key.text) != known_.end()) continue;
    complaints_.add(entry.key, "found the unknown key '" + entry.key.text + "' in " + what_ +
                                   "; expected " + one_of(known_) +
                                   did_you_mean(entry.key.text, known_));
  }
}

const std::vector<YamlNode>& read_list(const YamlNode& node, const std::string& what,
                                       Diagnostics& complaints) {
  static const std::vector<YamlNode> kEmpty;
  if (node.kind == YamlNode::Kind::kSequence) return node.items;
  complaints.add(node, "found " + describe(node) + "; expected a list of " + what);
  return kEmpty;
}

}  // namespace clearance
