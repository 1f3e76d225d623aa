// One map holds the names of groups and of objects, since a rule may use either. Each entry
// remembers whether a rule used it, so that unused groups are found.
#include "config/cell/group_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/scene/attached.hpp"
#include "config/text/spelling.hpp"

namespace clearance {
// Objects are added first: a group with an object's name is then the one that is reported.
GroupIndex::GroupIndex(const ObjectList& list, Diagnostics& diagnostics)
    : list_(list), diagnostics_(diagnostics) {
  for (std::uint32_t i = 0; i < list.objects.size(); ++i) {
    if (!list.objects[i].name.empty()) entries_[list.objects[i].name] = {{i}, false, false};
  }
  count_attached();
  for (std::uint32_t i = 0; i < list.objects.size(); ++i) {
    for (const std::string& group : list.objects[i].groups) {
      const auto [entry, is_new] = entries_.try_emplace(group, Entry{{}, true, false});
      if (entry->second.is_group) {
        entry->second.objects.push_back(i);
      } else {
        diagnostics_.add(*list.places[i],
                         fmt::format("found the group '{}' of object '{}'; expected another name, "
                                     "since an object has this one",
                                     group, list.objects[i].name));
      }
    }
  }
}

void GroupIndex::declare(const std::string& group, const YamlNode& place, std::string why) {
  Entry& entry = entries_[group];
  if (!entry.is_group && !entry.objects.empty()) {
    diagnostics_.add(place, fmt::format("{}, the group '{}', which is the name of an object; "
                                        "expected another name",
                                        why, group));
    return;
  }
  entry.is_group = true;
  entry.declared = &place;
  entry.why = std::move(why);
}

// A carrier comes before what it carries: what that one carries, too, is added to all carriers.
void GroupIndex::count_attached() {
  const std::vector<std::uint32_t> carriers = carriers_of(list_.attachments, list_.objects.size());
  for (const auto& [object, first] : list_.attachments) {
    for (std::uint32_t at = first; at != kNoCarrier; at = carriers[at]) {
      const auto found = entries_.find(list_.objects[at].name);
      if (found == entries_.end()) break;
      Entry& entry = found->second;
      if (entry.with_attached.empty()) entry.with_attached = entry.objects;
      entry.with_attached.push_back(object);
    }
  }
}

// Unknown names are reported only when all names are known: otherwise the name may belong to an
// object that could not be read.
const std::vector<std::uint32_t>* GroupIndex::find(const YamlNode& node, const std::string& name,
                                                   Attached attached) {
  const auto found = entries_.find(name);
  if (found != entries_.end()) {
    found->second.used = true;
    const Entry& entry = found->second;
    const bool counts = attached == Attached::kCount && !entry.with_attached.empty();
    return counts ? &entry.with_attached : &entry.objects;
  }
  if (list_.names_known) {
    std::vector<std::string> names;
    for (const auto& [known, entry] : entries_) names.push_back(known);
    diagnostics_.add(
        node, fmt::format("found the unknown name '{}'; expected a group or an object{}", name,
                          did_you_mean(name, names)));
  }
  return nullptr;
}

// Both names are looked up even when the first is unknown, so that one run reports both.
std::optional<Between> GroupIndex::read_between(MapReader& map, Attached attached) {
  const YamlNode* node = map.required("between");
  if (node == nullptr) return std::nullopt;
  if (node->kind != YamlNode::Kind::kSequence || node->items.size() != 2) {
    diagnostics_.add(
        *node, fmt::format("found {}; expected two groups or objects: [A, B]", describe(*node)));
    return std::nullopt;
  }
  Between between{};
  if (const YamlNode* flag = map.optional("may_be_empty"))
    between.may_be_empty = read_flag(*flag, diagnostics_).value_or(false);
  for (std::size_t side = 0; side < 2; ++side) {
    const YamlNode& item = node->items[side];
    if (const auto name = read_name(item, "a group or an object", diagnostics_)) {
      between.names[side] = *name;
      between.objects[side] = find(item, *name, attached);
      const auto entry = entries_.find(*name);
      if (entry != entries_.end() && entry->second.declared != nullptr) between.may_be_empty = true;
    }
  }
  if (between.objects[0] == nullptr || between.objects[1] == nullptr) return std::nullopt;
  return between;
}

// The result is sorted, without repetitions: [arm, arm] meets every pair from both sides.
std::vector<PairKey> GroupIndex::pairs(const Between& between) const {
  std::vector<PairKey> keys;
  for (const std::uint32_t a : *between.objects[0]) {
    for (const std::uint32_t b : *between.objects[1]) {
      if (a == b || never_meet(list_.objects[a], list_.objects[b])) continue;
      keys.push_back(pair_key(a, b));
    }
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  if (!list_.left_out.empty()) {
    std::erase_if(keys,
                  [&](PairKey key) { return std::ranges::binary_search(list_.left_out, key); });
  }
  return keys;
}

bool GroupIndex::has_rigid(const Between& between) const {
  return std::ranges::any_of(list_.rigid, [&](PairKey key) {
    const auto has = [&](std::size_t side, std::uint32_t object) {
      return std::ranges::find(*between.objects[side], object) != between.objects[side]->end();
    };
    const std::uint32_t a = first_of(key), b = second_of(key);
    return (has(0, a) && has(1, b)) || (has(0, b) && has(1, a));
  });
}

// A misspelt group probably means one that rules name: those are suggested.
void GroupIndex::refuse_unused_groups() const {
  std::vector<std::string> used;
  for (const auto& [name, entry] : entries_) {
    if (entry.is_group && entry.used) used.push_back(name);
  }
  for (const auto& [name, entry] : entries_) {
    if (!entry.is_group || entry.used || list_.optional_groups.contains(name)) continue;
    if (entry.declared != nullptr) {
      diagnostics_.add(
          *entry.declared,
          fmt::format("{}, and nothing under 'pairs' that names the group '{}' of what "
                      "it adds; expected a rule, as {{between: [ROBOT, {}]}}",
                      entry.why, name, name));
      continue;
    }
    const std::uint32_t object = entry.objects.front();
    diagnostics_.add(
        *list_.places[object],
        fmt::format(
            "found the group '{}' of object '{}', which nothing under 'pairs', "
            "'allowed_collisions', 'zones' or 'contacts' names; expected every group to be used{}",
            name, list_.objects[object].name, did_you_mean(name, used)));
  }
}

}  // namespace clearance
