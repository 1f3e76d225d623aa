#include "config/scene/pairs_between.hpp"

#include <algorithm>

namespace clearance {
namespace {

bool is_named(const Object& object, const std::string& name) {
  return object.name == name || std::ranges::count(object.groups, name) > 0;
}

}  // namespace

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

}  // namespace clearance
