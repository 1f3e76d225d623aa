#include "monitor/zones/zones.hpp"

#include <algorithm>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

constexpr std::uint32_t kAnyObject = ~0u;

// Returns the cause that this object alone would give for a pair of it being inside a zone. What a
// sensor sees may always have moved since its frame, and is late only as its frame is.
ZoneCause cause_of(const Object& object_of_scene, const TrackedObject& object) noexcept {
  if (!object.input.has_value) return ZoneCause::kUnknown;
  const bool is_late = object.input.late || !object_of_scene.is_seen();
  if (object.unobserved > 0.0 && (object.input.contradicted || is_late))
    return object.input.contradicted ? ZoneCause::kContradicted : ZoneCause::kLate;
  return object.discontinuous ? ZoneCause::kDiscontinuous : ZoneCause::kNear;
}

// The cause that the contact of a pair in a zone gives; kNear: none.
ZoneCause cause_of(const ContactReport* contact) noexcept {
  if (contact == nullptr) return ZoneCause::kNear;
  if (contact->status == ContactStatus::kTooDeep) return ZoneCause::kContactTooDeep;
  return contact->status == ContactStatus::kTooLate ? ZoneCause::kContactTooLate : ZoneCause::kNear;
}

// Returns true when the pair would be inside, now or since the last tick, if all its poses had been
// on time.
bool is_near(const ZoneReport& report, const TrackedObject& a, const TrackedObject& b,
             double threshold) noexcept {
  if (!a.known() || !b.known()) return false;
  const double unobserved = a.unobserved + b.unobserved;
  if (report.clearance + unobserved < threshold) return true;
  return !a.discontinuous && !b.discontinuous && report.swept_clearance + unobserved < threshold;
}

}  // namespace

Zones::Zones(const Scene& scene, const ZoneLevels& levels, const Contacts& contacts)
    : scene_(scene),
      levels_(levels),
      contacts_(contacts),
      reports_(scene.zones.size()),
      added_(scene.zones.size()),
      absent_(scene.zones.size()) {
  for (std::size_t z = 0; z < scene.zones.size(); ++z) {
    if (!scene.zones[z].pairs.empty()) reports_[z].pair = scene.zones[z].pairs.front();
  }
  updates_.reserve(scene.zones.size());
  begin_tick();
}

// The pair that decides is found anew in the next tick: it may be absent from this scene.
void Zones::take_over(const Zones& before, const SceneMap& map) noexcept {
  for (std::size_t z = 0; z < reports_.size(); ++z) {
    if (map.zones[z] == SceneMap::kNone) continue;
    const std::uint32_t pair = reports_[z].pair;
    reports_[z] = before.reports_[map.zones[z]];
    reports_[z].pair = pair;
  }
  begin_tick();
}

void Zones::save(StateWriter& out) const { out.put(std::span(reports_)); }

void Zones::restore(StateReader& in) noexcept {
  in.take(std::span(reports_));
  for (const ZoneReport& report : reports_) {
    in.expect(are_flags(report.active, report.certified, report.changed) &&
              report.cause <= ZoneCause::kNoShare);
    in.expect(report.pair < std::max<std::size_t>(scene_.pairs.size(), 1) &&
              report.cause_object < std::max<std::size_t>(scene_.objects.size(), 1));
  }
  if (in.good()) begin_tick();
}

void Zones::count_absent(std::span<const TrackedObject> objects) noexcept {
  for (std::size_t z = 0; z < absent_.size(); ++z) {
    absent_[z] = static_cast<std::uint32_t>(
        std::ranges::count_if(scene_.zones[z].pairs, [&](std::uint32_t pair) {
          return objects[scene_.pairs[pair].first].absent ||
                 objects[scene_.pairs[pair].second].absent;
        }));
  }
}

// Finds a pair of the zone that has this object (kAnyObject: any object) and no absent one. Returns
// `preferred` if that is such a pair.
std::optional<std::uint32_t> Zones::present_pair(
    std::uint32_t zone, std::uint32_t preferred, std::uint32_t object,
    std::span<const TrackedObject> objects) const noexcept {
  if (absent_[zone] == 0) return preferred;
  const auto fits = [&](std::uint32_t pair) {
    const ObjectPair& of = scene_.pairs[pair];
    const bool has = object == kAnyObject || of.first == object || of.second == object;
    return has && !objects[of.first].absent && !objects[of.second].absent;
  };
  if (fits(preferred)) return preferred;
  const auto found = std::ranges::find_if(scene_.zones[zone].pairs, fits);
  if (found == scene_.zones[zone].pairs.end()) return std::nullopt;
  return *found;
}

void Zones::begin_tick() noexcept {
  updates_.clear();
  for (std::size_t z = 0; z < reports_.size(); ++z) {
    updates_.emplace_back(scene_.zones[z], reports_[z]);
    added_[z] = 0;
  }
}

double Zones::undecided(std::uint32_t pair, double lower, double swept_lower) const noexcept {
  if (const double allowed = contacts_.least_allowed(pair); allowed < kInfinity)
    return swept_lower < allowed && allowed <= lower ? allowed : -kInfinity;
  double farthest = -kInfinity;
  for (const ZoneLevels::Membership& in : levels_.zones_of(pair)) {
    const double level = rounded_up(updates_[in.zone].threshold() + in.margins);
    if (swept_lower < level && level <= lower) farthest = std::max(farthest, level);
  }
  return farthest;
}

void Zones::add(std::uint32_t pair, const PairBounds& bounds) noexcept {
  const bool is_allowed = contacts_.allow(pair);
  for (const ZoneLevels::Membership& in : levels_.zones_of(pair)) {
    if (!is_allowed) updates_[in.zone].add(pair, bounds, in.margins);
    ++added_[in.zone];
  }
}

void Zones::finish(std::span<const TrackedObject> objects, const Clearance& waiting, bool any_lost,
                   std::uint64_t cycle) noexcept {
  for (std::uint32_t z = 0; z < updates_.size(); ++z) {
    ZoneHysteresis& update = updates_[z];
    // A pair that was not added is absent, culled, waiting or unknown. Culled ones are outside by
    // the invariant of the broad phase (monitor/schedule/BROAD_PHASE.md).
    if (added_[z] + absent_[z] < scene_.zones[z].pairs.size()) {
      const auto least = [&](double lower) {
        return std::min(ZoneLevels::threshold(scene_.zones[z], true),
                        rounded_down(lower - levels_.most_margins(z)));
      };
      const auto pair = present_pair(z, reports_[z].pair, kAnyObject, objects);
      update.add_rest({.now = least(waiting.now), .since = least(waiting.since)},
                      pair.value_or(reports_[z].pair));
    }
    if (any_lost) add_lost(z, objects);
    update.finish(cycle, reports_[z]);
  }
  begin_tick();
}

// An object that is not known may be anywhere now. One that has made a discontinuity may have been
// anywhere since the last tick.
void Zones::add_lost(std::uint32_t zone, std::span<const TrackedObject> objects) noexcept {
  for (const ZoneLevels::Member& member : levels_.members_of(zone)) {
    const TrackedObject& object = objects[member.object];
    if (object.absent || (object.known() && !object.discontinuous)) continue;
    const auto pair = present_pair(zone, member.pair, member.object, objects);
    if (!pair) continue;
    if (!object.known()) updates_[zone].add_rest({-kInfinity, -kInfinity}, *pair);
    if (object.discontinuous) updates_[zone].add_rest({.since = -kInfinity}, *pair);
  }
}

// The weightier cause of the pair's two objects counts. If both are late, the one that may have
// moved farther counts. A pair in an allowed contact would be outside if its poses were on time,
// however near it is.
void Zones::explain(std::span<const TrackedObject> objects) noexcept {
  for (std::size_t z = 0; z < reports_.size(); ++z) {
    ZoneReport& report = reports_[z];
    report.cause = report.active ? ZoneCause::kNear : ZoneCause::kInactive;
    report.cause_object = 0;
    if (!report.active) continue;  // a zone without pairs never is
    const std::uint32_t a = scene_.pairs[report.pair].first, b = scene_.pairs[report.pair].second;
    const ContactReport* contact = contacts_.find(report.pair);
    if (const ZoneCause cause = cause_of(contact); cause != ZoneCause::kNear) {
      report.cause = cause;
      continue;
    }
    const double level = ZoneLevels::threshold(scene_.zones[z], !report.changed);
    const bool is_excused = contact != nullptr && contact->ended == ContactEnded::kNot;
    if (!is_excused && is_near(report, objects[a], objects[b], level)) continue;
    const ZoneCause cause_a = cause_of(scene_.objects[a], objects[a]);
    const ZoneCause cause_b = cause_of(scene_.objects[b], objects[b]);
    const bool is_a =
        cause_a != cause_b ? cause_a > cause_b : objects[a].unobserved >= objects[b].unobserved;
    report.cause = is_a ? cause_a : cause_b;
    if (report.cause >= ZoneCause::kLate) report.cause_object = is_a ? a : b;
  }
}

}  // namespace clearance
