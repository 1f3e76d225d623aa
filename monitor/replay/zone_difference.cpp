// Reduces both sides to changes of state and finds the first position, zone by zone, where the two
// lists differ.
#include "monitor/replay/zone_difference.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "monitor/pair_name.hpp"
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

// NaN equals itself here, and -0 differs from 0.
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

// To the bit, as reports are compared.
bool same(const clearance_msg_ZoneState& a, const clearance_msg_ZoneState& b) {
  return a.cycle == b.cycle && a.active == b.active && a.pair == b.pair &&
         same_bits(a.clearance, b.clearance) && same_bits(a.swept_clearance, b.swept_clearance);
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
    changes_[zone].push_back(state);
  }
}

// The earliest difference of all zones.
std::optional<ZoneDifference::Found> ZoneDifference::first(const States& recorded) const {
  std::optional<Found> earliest;
  for (std::uint32_t zone = 0; zone < changes_.size(); ++zone) {
    const States theirs = changes_of(recorded, zone);
    const States& ours = changes_[zone];
    // Both lists have the changes in order of time.
    const auto [there, here] = std::ranges::mismatch(theirs, ours, same);
    if (there == theirs.end() && here == ours.end()) continue;
    const bool theirs_first =
        here == ours.end() || (there != theirs.end() && there->cycle <= here->cycle);
    const clearance_msg_ZoneState& at = theirs_first ? *there : *here;
    if (earliest && earliest->cycle <= at.cycle) continue;
    const auto side = [this](bool has, auto state) {
      return has ? described(scene_, *state) : std::string("no change");
    };
    earliest =
        Found{at.cycle, at.now_ns,
              fmt::format("zone '{}': recorded {}, replayed {}", scene_.zones[zone].name,
                          side(there != theirs.end(), there), side(here != ours.end(), here))};
  }
  return earliest;
}

}  // namespace clearance
