// Remembers each key that a reader asks for. The keys of the file that are not among them are
// unknown, so the list of accepted keys stands nowhere but in the reading code.
#include "config/yaml/map_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"
#include "config/yaml/scalar.hpp"

namespace clearance {
namespace {

constexpr std::size_t kUsualKeys = 24;  // that a reader asks for

}  // namespace

// Keys are checked once, here: YAML allows the same key twice, and the first would hide the second.
MapReader::MapReader(const YamlNode& node, std::string what, Diagnostics& diagnostics)
    : node_(node),
      what_(std::move(what)),
      diagnostics_(diagnostics),
      is_map_(node.kind == YamlNode::Kind::kMap) {
  if (!is_map_) {
    diagnostics_.add(node, fmt::format("found {}; expected {} (a map)", describe(node), what_));
    return;
  }
  known_.reserve(kUsualKeys);
  // The first place of each key.
  std::map<std::string_view, const YamlNode*> first;
  for (const YamlEntry& entry : node.entries) {
    if (entry.key.kind != YamlNode::Kind::kScalar) {
      diagnostics_.add(entry.key,
                       fmt::format("found {} as a key; expected a word", describe(entry.key)));
    } else if (const auto [same, is_new] = first.emplace(entry.key.text, &entry.key); !is_new) {
      diagnostics_.add(
          entry.key,
          fmt::format("found the key '{}' again; expected it once in {} (first in line {})",
                      entry.key.text, what_, same->second->line));
    }
  }
}

// A key that is read becomes known; refuse_unknown_keys() reports all others.
const YamlNode* MapReader::optional(std::string_view key) {
  known_.push_back(key);
  for (const YamlEntry& entry : node_.entries) {
    if (entry.key.kind == YamlNode::Kind::kScalar && entry.key.text == key) return &entry.value;
  }
  return nullptr;
}

// A node that is no map has been reported as such, so its missing keys are not.
const YamlNode* MapReader::required(std::string_view key) {
  const YamlNode* value = optional(key);
  if (value == nullptr && is_map_) {
    diagnostics_.add(node_, fmt::format("found no key '{}'; expected it in {}", key, what_));
  }
  return value;
}

// A misspelt optional key would otherwise silently mean a default.
void MapReader::refuse_unknown_keys() {
  for (const YamlEntry& entry : node_.entries) {
    if (entry.key.kind != YamlNode::Kind::kScalar) continue;
    const auto known = [&] { return std::vector<std::string>(known_.begin(), known_.end()); };
    if (std::find(known_.begin(), known_.end(), entry.key.text) != known_.end()) continue;
    diagnostics_.add(entry.key,
                     fmt::format("found the unknown key '{}' in {}; expected {}{}", entry.key.text,
                                 what_, one_of(known()), did_you_mean(entry.key.text, known())));
  }
}

// The reference leads to a static empty list where there is none.
const std::vector<YamlNode>& read_list(const YamlNode& node, std::string_view what,
                                       Diagnostics& diagnostics) {
  static const std::vector<YamlNode> kEmpty;
  if (node.kind == YamlNode::Kind::kSequence) return node.items;
  diagnostics.add(node, fmt::format("found {}; expected a list of {}", describe(node), what));
  return kEmpty;
}

}  // namespace clearance
