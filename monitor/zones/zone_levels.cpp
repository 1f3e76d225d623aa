#include "monitor/zones/zone_levels.hpp"

#include <algorithm>
#include <cmath>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// The margins of both its objects, rounded up, m.
double margins_of(const Scene& scene, std::uint32_t pair) noexcept {
  const ObjectPair& objects = scene.pairs[pair];
  return rounded_up(scene.objects[objects.first].margin + scene.objects[objects.second].margin);
}

}  // namespace

double ZoneLevels::threshold(const Zone& zone, bool active) noexcept {
  return active ? std::nextafter(zone.leave_above, kInfinity) : zone.enter_below;
}

ZoneLevels::ZoneLevels(const Scene& scene)
    : members_(scene.zones.size()), most_margins_(scene.zones.size(), 0.0) {
  if (scene.zones.empty()) return;
  first_zone_.assign(scene.pairs.size() + 1, 0);
  largest_thresholds_.assign(scene.pairs.size(), -kInfinity);
  for (const Zone& zone : scene.zones) {
    for (const std::uint32_t pair : zone.pairs) ++first_zone_[pair + 1];
  }
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) first_zone_[p + 1] += first_zone_[p];
  zones_.resize(first_zone_.back());
  std::vector<std::uint32_t> next(first_zone_.begin(), first_zone_.end() - 1);
  for (std::uint32_t z = 0; z < scene.zones.size(); ++z) {
    const double clearance = threshold(scene.zones[z], true);
    std::vector<std::uint8_t> is_member(scene.objects.size(), 0);
    for (const std::uint32_t pair : scene.zones[z].pairs) {
      const double margins = margins_of(scene, pair);
      zones_[next[pair]++] = {z, margins};
      largest_thresholds_[pair] =
          std::max(largest_thresholds_[pair], rounded_up(clearance + margins));
      for (const std::uint32_t object : {scene.pairs[pair].first, scene.pairs[pair].second}) {
        if (!is_member[object]) members_[z].push_back({object, pair});
        is_member[object] = 1;
      }
      most_margins_[z] = std::max(most_margins_[z], margins);
    }
  }
}

}  // namespace clearance
