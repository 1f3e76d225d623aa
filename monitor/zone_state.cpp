#include "monitor/zone_state.hpp"

#include <cmath>

#include "monitor/rounding.hpp"

namespace clearance {

ZoneUpdate::ZoneUpdate(const Scene& scene, const Zone& zone, const ZoneReport& before) noexcept
    : scene_(&scene),
      zone_(&zone),
      was_active_(before.active),
      pair_(before.pair),
      pair_since_(before.pair) {}

void ZoneUpdate::add(std::uint32_t pair, const PairSummary& summary) noexcept {
  const auto& [first, second, publish] = scene_->pairs[pair];
  const double margins = rounded_up(scene_->objects[first].margin + scene_->objects[second].margin);
  Clearance clearance{.now = summary.lower, .since = summary.lower_since};
  if (margins > 0.0) {
    clearance.now = rounded_down(clearance.now - margins);
    clearance.since = rounded_down(clearance.since - margins);
  }
  if (!proves(clearance, margins, summary)) proved_ = false;
  take(clearance, pair);
}

void ZoneUpdate::add_rest(const Clearance& clearance, std::uint32_t pair) noexcept {
  if (!outside(clearance.since)) proved_ = false;
  take(clearance, pair);
}

// Outside all the time; inside now, as far as can be told; or inside at some instant in between.
bool ZoneUpdate::proves(const Clearance& clearance, double margins,
                        const PairSummary& summary) const noexcept {
  if (outside(clearance.since)) return true;
  if (!outside(clearance.now)) return is_evaluated(summary.status);
  return !outside(rounded_up(summary.upper_since - margins));
}

void ZoneUpdate::finish(std::uint64_t cycle, ZoneReport& report) const noexcept {
  report.clearance = least_.now;
  report.clearance_since = least_.since;
  report.proved = proved_;
  report.active = !outside(least_.since);
  report.pair = report.active && outside(least_.now) ? pair_since_ : pair_;
  report.changed = report.active != was_active_;
  if (report.changed) report.since_cycle = cycle;
}

double ZoneUpdate::outside_from() const noexcept {
  return was_active_ ? well_outside() : zone_->enter_below;
}

double ZoneUpdate::well_outside() const noexcept {
  return std::nextafter(zone_->leave_above, kInfinity);
}

bool ZoneUpdate::outside(double clearance) const noexcept { return clearance >= outside_from(); }

void ZoneUpdate::take(const Clearance& clearance, std::uint32_t pair) noexcept {
  if (clearance.now < least_.now) {
    least_.now = clearance.now;
    pair_ = pair;
  }
  if (clearance.since < least_.since) {
    least_.since = clearance.since;
    pair_since_ = pair;
  }
}

}  // namespace clearance
