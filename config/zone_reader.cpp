#include "config/zone_reader.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace clearance {
namespace {

constexpr std::size_t kMaxZones = 256;  // idl/clearance.idl

std::optional<std::uint32_t> index_of(const std::vector<ObjectPair>& pairs, PairKey key) {
  const auto found = std::lower_bound(
      pairs.begin(), pairs.end(), key,
      [](const ObjectPair& a, PairKey b) { return pair_key(a.first, a.second) < b; });
  if (found == pairs.end() || pair_key(found->first, found->second) != key) return std::nullopt;
  return static_cast<std::uint32_t>(found - pairs.begin());
}

void fill_zone(const YamlNode& node, const Between& between, const ObjectList& objects,
               const PairList& list, const GroupIndex& members, Diagnostics& complaints,
               Zone& zone) {
  std::vector<PairKey> unwatched;
  for (const PairKey key : members.pairs(between)) {
    if (const auto index = index_of(list.pairs, key)) {
      zone.pairs.push_back(*index);
    } else if (!std::binary_search(list.allowed.begin(), list.allowed.end(), key)) {
      unwatched.push_back(key);
    }
  }
  if (!list.complete) return;  // what is missing here has been complained about
  if (!unwatched.empty()) {
    const PairKey key = unwatched.front();
    complaints.add(
        node, "found a zone over " + std::to_string(unwatched.size()) +
                  " pairs that are not watched, such as '" + objects.objects[first_of(key)].name +
                  "' against '" + objects.objects[second_of(key)].name +
                  "'; expected every pair of a zone under 'pairs' or 'allowed_collisions'");
  } else if (zone.pairs.empty()) {
    complaints.add(node, "found a zone over no pair: none between '" + between.names[0] +
                             "' and '" + between.names[1] + "' is watched; expected at least one");
  }
}

class ZoneReader {
 public:
  ZoneReader(const ObjectList& objects, const PairList& pairs, GroupIndex& members,
             const Quantities& quantities)
      : objects_(objects), pairs_(pairs), members_(members), quantities_(quantities) {}

  Zone read(const YamlNode& node) {
    Diagnostics& complaints = quantities_.complaints();
    Zone zone;
    MapReader map(node, "a zone", complaints);
    if (const YamlNode* name = map.required("name")) read_zone_name(*name, zone);
    const auto between = members_.read_between(map);
    read_thresholds(map, zone);
    map.refuse_unknown_keys();
    if (between) {
      zone.group_a = between->names[0];
      zone.group_b = between->names[1];
      fill_zone(node, *between, objects_, pairs_, members_, complaints, zone);
    }
    return zone;
  }

 private:
  void read_zone_name(const YamlNode& node, Zone& zone) {
    zone.name = read_name(node, "a zone's name", quantities_.complaints()).value_or("");
    if (zone.name.empty()) return;
    if (const auto [same, is_new] = names_.emplace(zone.name, &node); !is_new) {
      quantities_.complaints().add(node, "found the zone name '" + zone.name +
                                             "' again; expected it once " + "(first in line " +
                                             std::to_string(same->second->line) + ")");
    }
  }

  void read_thresholds(MapReader& map, Zone& zone) const {
    const YamlNode* enter_node = map.required("enter_below");
    const YamlNode* leave_node = map.required("leave_above");
    std::optional<double> enter, leave;
    if (enter_node != nullptr) {
      enter = quantities_.length(*enter_node, "the clearance below which the zone is entered",
                                 kNotNegative);
    }
    if (leave_node != nullptr) {
      leave = quantities_.length(*leave_node, "the clearance above which the zone is left",
                                 kNotNegative);
    }
    if (!enter || !leave) return;
    zone.enter_below = *enter;
    zone.leave_above = *leave;
    if (*leave < *enter) {
      quantities_.complaints().add(*leave_node,
                                   "found leave_above: " + leave_node->text +
                                       " below enter_below: " + enter_node->text +
                                       "; expected at least as much (the difference is the "
                                       "hysteresis)");
    }
  }

  const ObjectList& objects_;
  const PairList& pairs_;
  GroupIndex& members_;
  const Quantities& quantities_;
  std::map<std::string, const YamlNode*> names_;
};

}  // namespace

std::vector<Zone> read_zones(const YamlNode& node, const ObjectList& objects, const PairList& pairs,
                             GroupIndex& members, const Quantities& quantities) {
  std::vector<Zone> zones;
  ZoneReader reader(objects, pairs, members, quantities);
  for (const YamlNode& item : read_list(node, "zones", quantities.complaints())) {
    zones.push_back(reader.read(item));
  }
  if (zones.size() > kMaxZones) {
    quantities.complaints().add(node.items[kMaxZones], "found " + std::to_string(zones.size()) +
                                                           " zones; expected at most " +
                                                           std::to_string(kMaxZones));
  }
  return zones;
}

}  // namespace clearance
