#include "monitor/pairs/hidden_places.hpp"

#include <algorithm>

#include "monitor/clouds/seen_cloud.hpp"

namespace clearance {

HiddenPlaces::HiddenPlaces(const Scene& scene) {
  for (const std::uint32_t pair : hidden_pairs(scene)) {
    const std::uint32_t first = scene.pairs[pair].first, second = scene.pairs[pair].second;
    const bool first_is_seen = scene.objects[first].is_seen();
    places_.push_back(
        {scene.objects[first_is_seen ? first : second].sensor, first_is_seen ? second : first});
    reports_.push_back({.pair = pair});
  }
}

// A body that the frame does not list was not left out of it, and nothing is known of unseen
// places.
void HiddenPlaces::take(std::uint32_t sensor, const SeenCloud& cloud) noexcept {
  const std::span<const HiddenNear> hidden = cloud.hidden();
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].sensor != sensor) continue;
    HiddenReport& report = reports_[i];
    report = {.pair = report.pair, .thickness = 0.0};
    const auto found = std::ranges::lower_bound(hidden, places_[i].object, {}, &HiddenNear::object);
    if (found == hidden.end() || found->object != places_[i].object) continue;
    report.elements = static_cast<std::uint32_t>(found->shell.elements);
    report.thickness = found->shell.thickness;
    report.unseen = found->unseen;
    report.unseen_at = found->unseen_at;
  }
}

void HiddenPlaces::forget(std::uint32_t sensor) noexcept {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].sensor == sensor) reports_[i] = {.pair = reports_[i].pair};
  }
}

}  // namespace clearance
