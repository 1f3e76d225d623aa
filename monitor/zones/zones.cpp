#include "monitor/zones/zones.hpp"

#include <algorithm>

#include "monitor/motion/directed_rounding.hpp"

namespace clearance {
namespace {

// What an object contributes to a pair that is inside a zone.
ZoneCause cause_of(const TrackedObject& object) noexcept {
  if (!object.input.has_value) return ZoneCause::kUnknown;
  if (object.unseen_since > 0.0)
    return object.input.contradicted ? ZoneCause::kContradicted : ZoneCause::kLate;
  return object.discontinuous ? ZoneCause::kDiscontinuous : ZoneCause::kNear;
}

// Whether the pair would be inside if all its poses had been on time: now, or since the last tick.
bool is_near(const ZoneReport& report, const TrackedObject& a, const TrackedObject& b,
             double threshold) noexcept {
  if (!a.known() || !b.known()) return false;
  const double unseen = a.unseen_since + b.unseen_since;
  if (report.clearance + unseen < threshold) return true;
  return !a.discontinuous && !b.discontinuous && report.swept_clearance + unseen < threshold;
}

}  // namespace

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
    const double level = rounded_up(updates_[in.zone].threshold() + in.margins);
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
        return std::min(ZoneLevels::threshold(scene_.zones[z], true),
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

// The weightier cause of the pair's two objects counts, and of two late ones the one that may have
// moved farther.
void Zones::explain(std::span<const TrackedObject> objects) noexcept {
  for (std::size_t z = 0; z < reports_.size(); ++z) {
    ZoneReport& report = reports_[z];
    report.cause = report.active ? ZoneCause::kNear : ZoneCause::kInactive;
    report.cause_object = 0;
    if (!report.active || report.pair >= scene_.pairs.size()) continue;
    const std::uint32_t a = scene_.pairs[report.pair].first, b = scene_.pairs[report.pair].second;
    const double level = ZoneLevels::threshold(scene_.zones[z], !report.changed);
    if (is_near(report, objects[a], objects[b], level)) continue;
    const ZoneCause of_a = cause_of(objects[a]), of_b = cause_of(objects[b]);
    const bool is_a =
        of_a != of_b ? of_a > of_b : objects[a].unseen_since >= objects[b].unseen_since;
    report.cause = is_a ? of_a : of_b;
    report.cause_object = is_a ? a : b;
  }
}

}  // namespace clearance
