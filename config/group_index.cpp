#include "config/group_index.hpp"

#include <algorithm>

#include "config/spelling.hpp"

namespace clearance {

GroupIndex::GroupIndex(const ObjectList& list, Diagnostics& complaints)
    : list_(list), complaints_(complaints) {
  for (std::uint32_t i = 0; i < list.objects.size(); ++i) {
    if (!list.objects[i].name.empty()) entries_[list.objects[i].name] = {{i}, false, false};
  }
  for (std::uint32_t i = 0; i < list.objects.size(); ++i) {
    for (const std::string& group : list.objects[i].groups) {
      const auto [entry, is_new] = entries_.try_emplace(group, Entry{{}, true, false});
      if (entry->second.is_group) {
        entry->second.objects.push_back(i);
      } else {
        complaints_.add(*list.places[i],
                        "found the group '" + group + "' of object '" + list.objects[i].name +
                            "'; expected another name, since an object has this one");
      }
    }
  }
}

const std::vector<std::uint32_t>* GroupIndex::find(const YamlNode& node, const std::string& name) {
  const auto found = entries_.find(name);
  if (found != entries_.end()) {
    found->second.used = true;
    return &found->second.objects;
  }
  if (list_.names_known) {
    std::vector<std::string> names;
    for (const auto& [known, entry] : entries_) names.push_back(known);
    complaints_.add(node, "found the unknown name '" + name + "'; expected a group or an object" +
                              did_you_mean(name, names));
  }
  return nullptr;
}

std::optional<Between> GroupIndex::read_between(MapReader& map) {
  const YamlNode* node = map.required("between");
  if (node == nullptr) return std::nullopt;
  if (node->kind != YamlNode::Kind::kSequence || node->items.size() != 2) {
    complaints_.add(*node, "found " + describe(*node) + "; expected two groups or objects: [A, B]");
    return std::nullopt;
  }
  Between between{};
  for (std::size_t side = 0; side < 2; ++side) {
    const YamlNode& item = node->items[side];
    if (const auto name = read_name(item, "a group or an object", complaints_)) {
      between.names[side] = *name;
      between.objects[side] = find(item, *name);
    }
  }
  if (between.objects[0] == nullptr || between.objects[1] == nullptr) return std::nullopt;
  return between;
}

std::vector<PairKey> GroupIndex::pairs(const Between& between) const {
  std::vector<PairKey> keys;
  for (const std::uint32_t a : *between.objects[0]) {
    for (const std::uint32_t b : *between.objects[1]) {
      if (a == b || (list_.objects[a].fixed && list_.objects[b].fixed)) continue;
      keys.push_back(pair_key(a, b));
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  return keys;
}

void GroupIndex::refuse_unused_groups() const {
  std::vector<std::string> used;
  for (const auto& [name, entry] : entries_) {
    if (entry.is_group && entry.used) used.push_back(name);
  }
  for (const auto& [name, entry] : entries_) {
    if (!entry.is_group || entry.used) continue;
    const std::uint32_t object = entry.objects.front();
    complaints_.add(*list_.places[object],
                    "found the group '" + name + "' of object '" + list_.objects[object].name +
                        "', which nothing under 'pairs', 'allowed_collisions' or "
                        "'zones' names; expected every group to be used" +
                        did_you_mean(name, used));
  }
}

}  // namespace clearance
