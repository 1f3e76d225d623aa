// Reduces both sides to changes of state and finds the first position, zone by zone, where the two
// lists differ.
#include "monitor/replay/zone_difference.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "monitor/pair_name.hpp"
#include "monitor/replay/message_difference.hpp"
#include "monitor/wire/convert.hpp"

namespace clearance {
namespace {

using States = std::vector<clearance_msg_ZoneState>;

// The changes of one zone. A daemon also publishes every zone once at its start, which is no change
// unless it is active.
States changes_of(const States& recorded, std::uint32_t zone) {
  States changes;
  bool active = false;  // as every monitor begins
  for (const clearance_msg_ZoneState& state : recorded) {
    if (state.zone != zone || state.active == active) continue;
    active = state.active;
    changes.push_back(state);
  }
  return changes;
}

// 17 digits, so that values that differ look different.
std::string described(const Scene& scene, const clearance_msg_ZoneState& state) {
  return fmt::format("{} at tick {}, clearance {:.17g} m, since the last tick {:.17g} m ({})",
                     state.active ? "active" : "inactive", state.cycle, state.clearance,
                     state.swept_clearance, pair_name(scene, state.pair));
}

}  // namespace

// In the daemon's cycle numbers, so that both sides can be compared.
void ZoneDifference::replayed(const Report& report, std::uint64_t cycle_offset) {
  for (std::uint32_t zone = 0; zone < report.zones.size(); ++zone) {
    if (!report.zones[zone].changed) continue;
    clearance_msg_ZoneState state{};
    to_wire(scene_, report, zone, state);
    state.cycle += cycle_offset;
    state.since_cycle += cycle_offset;
    changes_[zone].push_back(state);
  }
}

// The earliest difference of all zones.
std::optional<ZoneDifference::Found> ZoneDifference::first(
    const States& recorded, const std::set<std::string>& not_recorded) const {
  std::optional<Found> earliest;
  for (std::uint32_t zone = 0; zone < changes_.size(); ++zone) {
    const auto found = first_of(zone, changes_of(recorded, zone), not_recorded);
    if (found && (!earliest || found->cycle < earliest->cycle)) earliest = found;
  }
  return earliest;
}

// Both lists have the changes in order of time.
std::optional<ZoneDifference::Found> ZoneDifference::first_of(
    std::uint32_t zone, const States& theirs, const std::set<std::string>& not_recorded) const {
  const States& ours = changes_[zone];
  std::optional<std::string> field;
  const auto agree = [&](const clearance_msg_ZoneState& a, const clearance_msg_ZoneState& b) {
    field = message_difference(scene_, a, b, {.not_recorded = &not_recorded});
    return !field;
  };
  const auto [there, here] = std::ranges::mismatch(theirs, ours, agree);
  if (there == theirs.end() && here == ours.end()) return std::nullopt;
  const bool both = there != theirs.end() && here != ours.end();
  if (both && there->cycle == here->cycle) {
    return Found{there->cycle, there->now_ns,
                 fmt::format("zone '{}', {}", scene_.zones[zone].name, *field)};
  }
  const bool theirs_first =
      here == ours.end() || (there != theirs.end() && there->cycle < here->cycle);
  const clearance_msg_ZoneState& at = theirs_first ? *there : *here;
  const auto side = [this](bool has, auto state) {
    return has ? described(scene_, *state) : std::string("no change");
  };
  return Found{at.cycle, at.now_ns,
               fmt::format("zone '{}': recorded {}, replayed {}", scene_.zones[zone].name,
                           side(there != theirs.end(), there), side(here != ours.end(), here))};
}

}  // namespace clearance
