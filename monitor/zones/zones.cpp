#include "monitor/zones/zones.hpp"

#include <algorithm>

#include "monitor/motion/directed_rounding.hpp"

namespace clearance {

Zones::Zones(const Scene& scene, const ZoneLevels& levels)
    : scene_(scene), levels_(levels), reports_(scene.zones.size()), added_(scene.zones.size()) {
  for (std::size_t z = 0; z < scene.zones.size(); ++z) {
    if (!scene.zones[z].pairs.empty()) reports_[z].pair = scene.zones[z].pairs.front();
  }
  updates_.reserve(scene.zones.size());
  begin_tick();
}

void Zones::begin_tick() noexcept {
  updates_.clear();
  for (std::size_t z = 0; z < reports_.size(); ++z) {
    updates_.emplace_back(scene_.zones[z], reports_[z]);
    added_[z] = 0;
  }
}

double Zones::undecided(std::uint32_t pair, double lower, double swept_lower) const noexcept {
  double farthest = -kInfinity;
  for (const ZoneLevels::Membership& in : levels_.zones_of(pair)) {
    const double level = rounded_up(updates_[in.zone].outside_from() + in.margins);
    if (swept_lower < level && level <= lower) farthest = std::max(farthest, level);
  }
  return farthest;
}

void Zones::add(std::uint32_t pair, const PairBounds& bounds) noexcept {
  for (const ZoneLevels::Membership& in : levels_.zones_of(pair)) {
    updates_[in.zone].add(pair, bounds, in.margins);
    ++added_[in.zone];
  }
}

void Zones::finish(std::span<const TrackedObject> objects, const Clearance& waiting,
                   std::uint64_t cycle) noexcept {
  for (std::uint32_t z = 0; z < updates_.size(); ++z) {
    ZoneHysteresis& update = updates_[z];
    // Pairs that were not added are culled or wait. Culled ones are outside by the broad phase's
    // invariant (monitor/broad_phase/README.md), so only what waits has to be said.
    if (added_[z] < scene_.zones[z].pairs.size()) {
      const auto least = [&](double lower) {
        return std::min(ZoneLevels::outside_from(scene_.zones[z], true),
                        rounded_down(lower - levels_.most_margins(z)));
      };
      update.add_rest({.now = least(waiting.now), .since = least(waiting.since)}, reports_[z].pair);
    }
    if (!objects.empty()) {
      for (const ZoneLevels::Member& member : levels_.members_of(z)) {
        const TrackedObject& object = objects[member.object];
        if (!object.known()) update.add_rest({-kInfinity, -kInfinity}, member.pair);
        if (object.discontinuous) update.add_rest({.since = -kInfinity}, member.pair);
      }
    }
    update.finish(cycle, reports_[z]);
  }
  begin_tick();
}

}  // namespace clearance
