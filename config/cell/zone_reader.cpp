// Finds the watched pairs between the two groups of a zone. A pair that is neither watched nor
// allowed to touch is reported as a mistake, since it could never make the zone active.
#include "config/cell/zone_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "config/cell/separation_reader.hpp"
#include "config/text/sentences.hpp"

namespace clearance {
namespace {

// The largest number of zones that fit into the catalogue message.
constexpr std::size_t kMaxZones = 256;  // idl/clearance.idl

// Fills in the watched pairs between the two sides of a zone. A pair that is neither watched nor
// allowed to touch is refused, since it could never make the zone active.
void fill_zone(const YamlNode& node, const Between& between, const ObjectList& objects,
               const PairList& list, const GroupIndex& group_index, Diagnostics& diagnostics,
               Zone& zone) {
  std::vector<PairKey> unwatched;
  for (const PairKey key : group_index.pairs(between)) {
    if (const auto index = pair_index(list.pairs, key)) {
      zone.pairs.push_back(*index);
    } else if (!std::binary_search(list.allowed.begin(), list.allowed.end(), key)) {
      unwatched.push_back(key);
    }
  }
  if (!list.complete) return;  // missing pairs have been reported
  if (!unwatched.empty()) {
    const PairKey key = unwatched.front();
    diagnostics.add(
        node,
        fmt::format(
            "found a zone over {} not watched, such as '{}' against '{}'; "
            "expected every pair of a zone under 'pairs' or 'allowed_collisions'",
            counted(unwatched.size(), "pair") + (unwatched.size() == 1 ? " that is" : " that are"),
            objects.objects[first_of(key)].name, objects.objects[second_of(key)].name));
  } else if (zone.pairs.empty() && !between.may_be_empty) {
    diagnostics.add(node, fmt::format("found a zone over no pair: none between '{}' and '{}' is "
                                      "watched; expected at least one",
                                      between.names[0], between.names[1]));
  }
}

// Reads zones one after another; their names must differ.
class ZoneReader {
 public:
  ZoneReader(const ObjectList& objects, const PairList& pairs, GroupIndex& group_index,
             const Quantities& quantities)
      : objects_(objects), pairs_(pairs), group_index_(group_index), quantities_(quantities) {}

  // A zone with a mistake stays in the list, so that the ids of those after it do not change.
  Zone read(const YamlNode& node) {
    Diagnostics& diagnostics = quantities_.diagnostics();
    Zone zone;
    MapReader map(node, "a zone", diagnostics);
    if (const YamlNode* name = map.required("name")) read_zone_name(*name, zone);
    const auto between = group_index_.read_between(map);
    const YamlNode* stops = map.optional("stops");
    if (stops != nullptr) zone.stop_margin = read_stop_margin(*stops);
    read_thresholds(map, stops != nullptr, zone);
    const YamlNode* separation = map.optional("separation");
    map.refuse_unknown_keys();
    if (between) {
      zone.group_a = between->names[0];
      zone.group_b = between->names[1];
      fill_zone(node, *between, objects_, pairs_, group_index_, diagnostics, zone);
      if (separation != nullptr) {
        zone.separation =
            read_separation(*separation, *between, zone, pairs_, objects_, quantities_);
      }
    }
    return zone;
  }

 private:
  // Names must differ because logs and --expect-no-zone refer to zones by name.
  void read_zone_name(const YamlNode& node, Zone& zone) {
    zone.name = read_name(node, "a zone's name", quantities_.diagnostics()).value_or("");
    if (zone.name.empty()) return;
    if (const auto [same, is_new] = names_.emplace(zone.name, &node); !is_new) {
      quantities_.diagnostics().add(
          node, fmt::format("found the zone name '{}' again; expected it once (first in line {})",
                            zone.name, same->second->line));
    }
  }

  [[nodiscard]] std::optional<double> read_stop_margin(const YamlNode& node) const {
    MapReader map(node, "the stops of a zone", quantities_.diagnostics());
    const YamlNode* margin = map.required("margin");
    map.refuse_unknown_keys();
    if (margin == nullptr) return std::nullopt;
    return quantities_.length(*margin, "the clearance that is kept until the robot stands",
                              kNotNegative);
  }

  // The difference of the two thresholds is the hysteresis, so it must not be negative. A zone with
  // `stops` may have none: only a clearance below 0 then enters it by distance.
  void read_thresholds(MapReader& map, bool has_stops, Zone& zone) const {
    const auto threshold = [&](const char* key) {
      return has_stops ? map.optional(key) : map.required(key);
    };
    const YamlNode* enter_node = threshold("enter_below");
    const YamlNode* leave_node = threshold("leave_above");
    if (has_stops && (enter_node == nullptr) != (leave_node == nullptr)) {
      quantities_.diagnostics().add(
          enter_node != nullptr ? *enter_node : *leave_node,
          fmt::format("found {}; expected both or none", enter_node != nullptr
                                                             ? "enter_below without leave_above"
                                                             : "leave_above without enter_below"));
    }
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
      quantities_.diagnostics().add(
          *leave_node, fmt::format("found leave_above: {} below enter_below: {}; expected at least "
                                   "as much (the difference is the hysteresis)",
                                   leave_node->text, enter_node->text));
    }
  }

  const ObjectList& objects_;
  const PairList& pairs_;
  GroupIndex& group_index_;
  const Quantities& quantities_;
  // The first place of each name.
  std::map<std::string, const YamlNode*> names_;
};

// Publishes every pair of a zone with `separation`, because its published terms need a distance of
// the same tick.
void publish_separated_pairs(const YamlNode& node, const std::vector<Zone>& zones,
                             std::vector<ObjectPair>& pairs, Diagnostics& diagnostics) {
  std::size_t separated = 0;
  for (const Zone& zone : zones) {
    if (!zone.separation) continue;
    separated += zone.pairs.size();
    for (const std::uint32_t pair : zone.pairs) pairs[pair].publish = true;
  }
  if (separated == 0) return;
  const auto published =
      static_cast<std::size_t>(std::ranges::count(pairs, true, &ObjectPair::publish));
  if (std::max(separated, published) <= kMaxPublished) return;
  diagnostics.add(node, fmt::format("found {} pairs in zones with 'separation', which are "
                                    "published, and {} published pairs in all; expected at most "
                                    "{} of either: put fewer objects on each side of the zones",
                                    separated, published, kMaxPublished));
}

}  // namespace

// Zones stay in the order of the file: their index is their id in a report.
std::vector<Zone> read_zones(const YamlNode& node, const ObjectList& objects,
                             GroupIndex& group_index, const Quantities& quantities,
                             PairList& pairs) {
  std::vector<Zone> zones;
  ZoneReader reader(objects, pairs, group_index, quantities);
  for (const YamlNode& item : read_list(node, "zones", quantities.diagnostics())) {
    zones.push_back(reader.read(item));
  }
  if (zones.size() > kMaxZones) {
    quantities.diagnostics().add(
        node.items[kMaxZones],
        fmt::format("found {} zones; expected at most {}", zones.size(), kMaxZones));
  }
  publish_separated_pairs(node, zones, pairs.pairs, quantities.diagnostics());
  return zones;
}

}  // namespace clearance
