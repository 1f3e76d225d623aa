// Reduces both sides to changes of state and finds the first position, zone by zone, where the two
// lists differ.
#include "monitor/replay/zone_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "monitor/interface/pair_name.hpp"
#include "monitor/replay/message_difference.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

bool has_zone(const Scene& scene, const std::string& name) {
  return std::ranges::find(scene.zones, name, &Zone::name) != scene.zones.end();
}

}  // namespace

void ZoneDifference::change(const Scene& scene, std::uint64_t from) {
  scenes_.push_back({&scene, from});
  for (const Zone& zone : scene.zones) replayed_.try_emplace(zone.name);
  for (auto& [name, zone] : replayed_) zone.active = zone.active && has_zone(scene, name);
}

const Scene& ZoneDifference::scene_at(std::uint64_t cycle) const {
  const auto after = std::ranges::upper_bound(scenes_, cycle, {}, &InForce::from);
  return *(after == scenes_.begin() ? after : std::prev(after))->scene;
}

// Recorded ids are checked, and a message may have cut the name.
bool ZoneDifference::is_of(const clearance_msg_ZoneState& state, const std::string& zone) const {
  const Scene& scene = scene_at(state.cycle);
  return state.zone < scene.zones.size() && scene.zones[state.zone].name == zone;
}

// Cycles are the daemon's numbers, so that both sides can be compared. A zone of a changed scene
// may have changed in a tick before its first report, so states are compared, as the recorder does.
void ZoneDifference::replayed(const Report& report, std::uint64_t cycle_offset) {
  const Scene& scene = *scenes_.back().scene;
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    Replayed& ours = replayed_[scene.zones[zone].name];
    if (report.zones[zone].active == ours.active) continue;
    ours.active = report.zones[zone].active;
    clearance_msg_ZoneState& state = ours.changes.emplace_back();
    state = {};
    to_wire(scene, report, zone, state);
    state.cycle += cycle_offset;
    state.since_cycle += cycle_offset;
  }
}

// The changes of one zone. A daemon also publishes every zone once at its start, and after a change
// of the scene, which is no change of the zone.
ZoneDifference::States ZoneDifference::changes_of(const States& recorded,
                                                  const std::string& zone) const {
  States changes;
  bool active = false;  // as every monitor begins
  auto scene = scenes_.begin();
  for (const clearance_msg_ZoneState& state : recorded) {
    for (; scene != scenes_.end() && scene->from <= state.cycle; ++scene)
      active = active && has_zone(*scene->scene, zone);
    if (!is_of(state, zone) || state.active == active) continue;
    active = state.active;
    changes.push_back(state);
  }
  return changes;
}

// 17 digits, so that values that differ look different.
std::string ZoneDifference::described(const clearance_msg_ZoneState& state) const {
  return fmt::format("{} at tick {}, clearance {:.17g} m, since the last tick {:.17g} m ({})",
                     state.active ? "active" : "inactive", state.cycle, state.clearance,
                     state.swept_clearance, pair_name(scene_at(state.cycle), state.pair));
}

// The earliest difference of all zones.
std::optional<ZoneDifference::Found> ZoneDifference::first(
    const States& recorded, const std::set<std::string>& not_recorded) const {
  std::optional<Found> earliest;
  for (const auto& [zone, ours] : replayed_) {
    const auto found = first_of(zone, ours.changes, changes_of(recorded, zone), not_recorded);
    if (found && (!earliest || found->cycle < earliest->cycle)) earliest = found;
  }
  return earliest;
}

// Both lists have the changes in order of time.
std::optional<ZoneDifference::Found> ZoneDifference::first_of(
    const std::string& zone, const States& ours, const States& theirs,
    const std::set<std::string>& not_recorded) const {
  std::optional<std::string> field;
  const auto agree = [&](const clearance_msg_ZoneState& a, const clearance_msg_ZoneState& b) {
    field = message_difference(scene_at(b.cycle), a, b, {.not_recorded = &not_recorded});
    return !field;
  };
  const auto [there, here] = std::ranges::mismatch(theirs, ours, agree);
  if (there == theirs.end() && here == ours.end()) return std::nullopt;
  const bool both = there != theirs.end() && here != ours.end();
  if (both && there->cycle == here->cycle) {
    return Found{there->cycle, there->now_ns, fmt::format("zone '{}', {}", zone, *field)};
  }
  const bool theirs_first =
      here == ours.end() || (there != theirs.end() && there->cycle < here->cycle);
  const clearance_msg_ZoneState& at = theirs_first ? *there : *here;
  const auto side = [this](bool has, auto state) {
    return has ? described(*state) : std::string("no change");
  };
  return Found{at.cycle, at.now_ns,
               fmt::format("zone '{}': recorded {}, replayed {}", zone,
                           side(there != theirs.end(), there), side(here != ours.end(), here))};
}

}  // namespace clearance
