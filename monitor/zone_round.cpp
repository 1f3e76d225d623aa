#include "monitor/zone_round.hpp"

#include <algorithm>

#include "monitor/rounding.hpp"

namespace clearance {

ZoneRound::ZoneRound(const Scene& scene)
    : scene_(scene), members_(scene.zones.size()), most_margins_(scene.zones.size(), 0.0) {
  for (const Object& object : scene.objects) margins_.push_back(object.margin);
  updates_.reserve(scene.zones.size());
  added_.resize(scene.zones.size());
  if (scene.zones.empty()) return;
  first_zone_.assign(scene.pairs.size() + 1, 0);
  for (const Zone& zone : scene.zones) {
    for (const std::uint32_t pair : zone.pairs) ++first_zone_[pair + 1];
  }
  for (std::size_t p = 0; p < scene.pairs.size(); ++p) first_zone_[p + 1] += first_zone_[p];
  zones_.resize(first_zone_.back());
  std::vector<std::uint32_t> next(first_zone_.begin(), first_zone_.end() - 1);
  for (std::uint32_t z = 0; z < scene.zones.size(); ++z) {
    std::vector<std::uint8_t> is_member(scene.objects.size(), 0);
    for (const std::uint32_t pair : scene.zones[z].pairs) {
      zones_[next[pair]++] = z;
      for (const std::uint32_t object : {scene.pairs[pair].first, scene.pairs[pair].second}) {
        if (!is_member[object]) members_[z].push_back({object, pair});
        is_member[object] = 1;
      }
      most_margins_[z] = std::max(most_margins_[z], margins_of(pair));
    }
  }
}

void ZoneRound::begin(const std::vector<ZoneReport>& reports) noexcept {
  updates_.clear();
  for (std::size_t z = 0; z < scene_.zones.size(); ++z) {
    updates_.emplace_back(scene_.zones[z], reports[z]);
    added_[z] = 0;
  }
}

double ZoneRound::undecided(std::uint32_t pair, double lower, double lower_since) const noexcept {
  const double margins = margins_of(pair);
  double farthest = -kInfinity;
  for (const std::uint32_t zone : zones_of(pair)) {
    const double level = rounded_up(updates_[zone].outside_from() + margins);
    if (lower_since < level && level <= lower) farthest = std::max(farthest, level);
  }
  return farthest;
}

void ZoneRound::add(std::uint32_t pair, const PairSummary& summary) noexcept {
  const auto zones = zones_of(pair);
  if (zones.empty()) return;
  const double margins = margins_of(pair);
  for (const std::uint32_t zone : zones) {
    updates_[zone].add(pair, summary, margins);
    ++added_[zone];
  }
}

void ZoneRound::finish(const std::vector<ObjectState>& objects, const Clearance& pending,
                       std::uint64_t cycle, std::vector<ZoneReport>& reports) noexcept {
  const bool any_lost = std::any_of(objects.begin(), objects.end(), [](const ObjectState& object) {
    return !object.known() || object.leapt;
  });
  for (std::size_t z = 0; z < updates_.size(); ++z) {
    ZoneUpdate& update = updates_[z];
    if (added_[z] < scene_.zones[z].pairs.size()) {
      const auto least = [&](double lower) {
        return std::min(update.well_outside(), rounded_down(lower - most_margins_[z]));
      };
      update.add_rest({.now = least(pending.now), .since = least(pending.since)}, reports[z].pair);
    }
    for (std::size_t m = 0; any_lost && m < members_[z].size(); ++m) {
      const Member& member = members_[z][m];
      const ObjectState& object = objects[member.object];
      if (!object.known()) update.add_rest({-kInfinity, -kInfinity}, member.pair);
      if (object.leapt) update.add_rest({.since = -kInfinity}, member.pair);
    }
    update.finish(cycle, reports[z]);
  }
}

double ZoneRound::margins_of(std::uint32_t pair) const noexcept {
  const ObjectPair& objects = scene_.pairs[pair];
  return rounded_up(margins_[objects.first] + margins_[objects.second]);
}

std::span<const std::uint32_t> ZoneRound::zones_of(std::uint32_t pair) const noexcept {
  if (first_zone_.empty()) return {};
  return std::span(zones_).subspan(first_zone_[pair], first_zone_[pair + 1] - first_zone_[pair]);
}

}  // namespace clearance
