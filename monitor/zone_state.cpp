#include "monitor/zone_state.hpp"

#include <cmath>

#include "monitor/rounding.hpp"

namespace clearance {

ZoneUpdate::ZoneUpdate(const Scene& scene, const Zone& zone, const ZoneReport& before) noexcept
    : scene_(&scene), zone_(&zone), was_active_(before.active), pair_(before.pair) {}

void ZoneUpdate::add(std::uint32_t pair, const PairSummary& summary) noexcept {
  const auto& [first, second, publish] = scene_->pairs[pair];
  const double margins = scene_->objects[first].margin + scene_->objects[second].margin;
  const double clearance =
      margins > 0.0 ? rounded_down(summary.lower - rounded_up(margins)) : summary.lower;
  if (!outside(clearance) && !is_evaluated(summary.status)) proved_ = false;
  take(clearance, pair);
}

void ZoneUpdate::add_rest(double clearance, std::uint32_t pair) noexcept {
  if (!outside(clearance)) proved_ = false;
  take(clearance, pair);
}

void ZoneUpdate::finish(std::uint64_t cycle, ZoneReport& report) const noexcept {
  report.clearance = clearance_;
  report.proved = proved_;
  report.pair = pair_;
  report.active =
      was_active_ ? !(clearance_ > zone_->leave_above) : clearance_ < zone_->enter_below;
  report.changed = report.active != was_active_;
  if (report.changed) report.since_cycle = cycle;
}

double ZoneUpdate::well_outside() const noexcept {
  return std::nextafter(zone_->leave_above, kInfinity);
}

bool ZoneUpdate::outside(double clearance) const noexcept {
  return was_active_ ? clearance > zone_->leave_above : clearance >= zone_->enter_below;
}

void ZoneUpdate::take(double clearance, std::uint32_t pair) noexcept {
  if (any_ && !(clearance < clearance_)) return;
  any_ = true;
  clearance_ = clearance;
  pair_ = pair;
}

}  // namespace clearance
