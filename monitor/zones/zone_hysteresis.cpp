#include "monitor/zones/zone_hysteresis.hpp"

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {

ZoneHysteresis::ZoneHysteresis(const Zone& zone, const ZoneReport& before) noexcept
    : was_active_(before.active),
      threshold_(ZoneLevels::threshold(zone, before.active)),
      pair_(before.pair),
      swept_pair_(before.pair) {}

void ZoneHysteresis::add(std::uint32_t pair, const PairBounds& bounds, double margins) noexcept {
  Clearance clearance{.now = bounds.lower, .since = bounds.swept_lower};
  if (margins > 0.0) {
    clearance.now = rounded_down(clearance.now - margins);
    clearance.since = rounded_down(clearance.since - margins);
  }
  if (!proves(clearance, margins, bounds)) proved_ = false;
  take(clearance, pair);
}

void ZoneHysteresis::add_rest(const Clearance& clearance, std::uint32_t pair) noexcept {
  if (!outside(clearance.since)) proved_ = false;
  take(clearance, pair);
}

// Three states are certified: outside since the last tick; inside now, by an evaluation; inside at
// some instant between.
bool ZoneHysteresis::proves(const Clearance& clearance, double margins,
                            const PairBounds& bounds) const noexcept {
  if (outside(clearance.since)) return true;
  if (!outside(clearance.now)) return is_evaluated(bounds.status);
  return !outside(rounded_up(bounds.swept_upper - margins));
}

void ZoneHysteresis::finish(std::uint64_t cycle, ZoneReport& report) const noexcept {
  report.clearance = least_.now;
  report.swept_clearance = least_.since;
  report.certified = proved_;
  report.active = !outside(least_.since);
  report.pair = report.active && outside(least_.now) ? swept_pair_ : pair_;
  report.changed = report.active != was_active_;
  if (report.changed) report.since_cycle = cycle;
}

void ZoneHysteresis::take(const Clearance& clearance, std::uint32_t pair) noexcept {
  if (clearance.now < least_.now) {
    least_.now = clearance.now;
    pair_ = pair;
  }
  if (clearance.since < least_.since) {
    least_.since = clearance.since;
    swept_pair_ = pair;
  }
}

}  // namespace clearance
