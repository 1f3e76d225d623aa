#include "monitor/zones/zones.hpp"

#include <algorithm>

#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// Both of its objects', rounded up, m.
double margins_of(const Scene& scene, std::uint32_t pair) noexcept {
  const ObjectPair& objects = scene.pairs[pair];
  return rounded_up(scene.objects[objects.first].margin + scene.objects[objects.second].margin);
}

}  // namespace

Zones::Zones(const Scene& scene)
    : scene_(scene), members_(scene.zones.size()), most_margins_(scene.zones.size(), 0.0) {
  updates_.reserve(scene.zones.size());
  added_.resize(scene.zones.size());
  if (scene.zones.empty()) return;
  first_zone_.assign(scene.pairs.size() + 1, 0);
  outside_from_.assign(scene.pairs.size(), -kInfinity);
  for (const Zone& zone : scene.zones) {
    for (const std::uint32_t pair : zone.pairs) ++first_zone_[pair + 1];
  }
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) first_zone_[p + 1] += first_zone_[p];
  zones_.resize(first_zone_.back());
  std::vector<std::uint32_t> next(first_zone_.begin(), first_zone_.end() - 1);
  for (std::uint32_t z = 0; z < scene.zones.size(); ++z) {
    const double outside_from = ZoneHysteresis(scene.zones[z], {}).well_outside();
    std::vector<std::uint8_t> is_member(scene.objects.size(), 0);
    for (const std::uint32_t pair : scene.zones[z].pairs) {
      const double margins = margins_of(scene, pair);
      zones_[next[pair]++] = {z, margins};
      outside_from_[pair] = std::max(outside_from_[pair], rounded_up(outside_from + margins));
      for (const std::uint32_t object : {scene.pairs[pair].first, scene.pairs[pair].second}) {
        if (!is_member[object]) members_[z].push_back({object, pair});
        is_member[object] = 1;
      }
      most_margins_[z] = std::max(most_margins_[z], margins);
    }
  }
}

void Zones::begin(const std::vector<ZoneReport>& reports) noexcept {
  updates_.clear();
  for (std::size_t z = 0; z < scene_.zones.size(); ++z) {
    updates_.emplace_back(scene_.zones[z], reports[z]);
    added_[z] = 0;
  }
}

double Zones::undecided(std::uint32_t pair, double lower, double swept_lower) const noexcept {
  double farthest = -kInfinity;
  for (const Membership& in : zones_of(pair)) {
    const double level = rounded_up(updates_[in.zone].outside_from() + in.margins);
    if (swept_lower < level && level <= lower) farthest = std::max(farthest, level);
  }
  return farthest;
}

void Zones::add(std::uint32_t pair, const PairBounds& summary) noexcept {
  for (const Membership& in : zones_of(pair)) {
    updates_[in.zone].add(pair, summary, in.margins);
    ++added_[in.zone];
  }
}

void Zones::finish(std::span<const TrackedObject> objects, const Clearance& pending,
                   std::uint64_t cycle, std::vector<ZoneReport>& reports) noexcept {
  for (std::size_t z = 0; z < updates_.size(); ++z) {
    ZoneHysteresis& update = updates_[z];
    if (added_[z] < scene_.zones[z].pairs.size()) {
      const auto least = [&](double lower) {
        return std::min(update.well_outside(), rounded_down(lower - most_margins_[z]));
      };
      update.add_rest({.now = least(pending.now), .since = least(pending.since)}, reports[z].pair);
    }
    for (std::size_t m = 0; !objects.empty() && m < members_[z].size(); ++m) {
      const Member& member = members_[z][m];
      const TrackedObject& object = objects[member.object];
      if (!object.known()) update.add_rest({-kInfinity, -kInfinity}, member.pair);
      if (object.leapt) update.add_rest({.since = -kInfinity}, member.pair);
    }
    update.finish(cycle, reports[z]);
  }
}

}  // namespace clearance
