#include "config/scene/pairs_between.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "config/scene/attached.hpp"
#include "config/text/sentences.hpp"
#include "config/text/spelling.hpp"

namespace clearance {
std::vector<std::uint32_t> pairs_between(const Scene& scene, const std::string& a,
                                         const std::string& b) {
  if (b.empty()) {
    const auto zone = std::ranges::find(scene.zones, a, &Zone::name);
    return zone == scene.zones.end() ? std::vector<std::uint32_t>{} : zone->pairs;
  }
  std::vector<std::uint32_t> pairs;
  for (std::uint32_t p = 0; p < scene.pairs.size(); ++p) {
    const Object& first = scene.objects[scene.pairs[p].first];
    const Object& second = scene.objects[scene.pairs[p].second];
    if ((is_named(first, a) && is_named(second, b)) || (is_named(first, b) && is_named(second, a)))
      pairs.push_back(p);
  }
  return pairs;
}

std::string why_no_pairs_between(const Scene& scene, const std::string& a, const std::string& b) {
  if (b.empty()) {
    std::vector<std::string> zones;
    for (const Zone& zone : scene.zones) zones.push_back(zone.name);
    if (std::ranges::count(zones, a) > 0) return fmt::format("the zone '{}' has no pair", a);
    return fmt::format("the cell has no zone '{}'; {}", a,
                       zones.empty() ? "it has none" : "its zones are " + one_of(zones));
  }
  std::vector<std::string> names;
  for (const Object& object : scene.objects) {
    names.push_back(object.name);
    names.insert(names.end(), object.groups.begin(), object.groups.end());
  }
  for (const std::string& name : {a, b}) {
    if (std::ranges::count(names, name) == 0)
      return fmt::format("the cell has neither an object nor a group '{}'{}", name,
                         did_you_mean(name, names));
  }
  return fmt::format(
      "the cell watches no pair between '{}' and '{}'; expected two objects or groups that a rule "
      "under 'pairs:' names",
      a, b);
}

}  // namespace clearance
