#include "monitor/tick/stage_borders.hpp"

#include "monitor/interface/invariant.hpp"
#include "monitor/interface/tight_bounds.hpp"

namespace clearance {
namespace {

bool costly = kMoreInvariantsChecked;

void check_object(const TrackedObject& object) noexcept {
  CLEARANCE_INVARIANT(!object.absent || !object.input.has_value);
  if (!object.input.has_value) return;
  CLEARANCE_INVARIANT(is_usable(object.pose));
  CLEARANCE_INVARIANT(object.displacement >= 0.0);
  CLEARANCE_INVARIANT(object.accumulated_last_tick <= object.accumulated);
  CLEARANCE_INVARIANT(0.0 <= object.may_have_moved && object.may_have_moved <= object.unobserved);
}

void check_zones(std::span<const ZoneReport> zones) noexcept {
  for (const ZoneReport& zone : zones) {
    CLEARANCE_INVARIANT(zone.swept_clearance <= zone.clearance);
    CLEARANCE_INVARIANT(zone.active == (zone.cause != ZoneCause::kInactive));
  }
}

void check_separations(std::span<const PairSeparation> pairs) noexcept {
  for (const PairSeparation& pair : pairs) {
    CLEARANCE_INVARIANT(0.0 <= pair.scaling && pair.scaling <= 1.0);
    CLEARANCE_INVARIANT(pair.remaining <= pair.clearance);
  }
}

}  // namespace

bool stage_borders_are_checked() noexcept { return kInvariantsChecked; }

void check_costly_borders() noexcept { costly = kInvariantsChecked; }

void check_displaced(std::span<const std::uint32_t> changed,
                     std::span<const std::uint32_t> first_part, const TickView& view) noexcept {
  if (!costly) return;
  for (const std::uint32_t i : changed) {
    check_object(view.objects[i]);
    if (!view.objects[i].input.has_value) continue;
    for (std::uint32_t part = first_part[i]; part < first_part[i + 1]; ++part)
      CLEARANCE_INVARIANT(view.parts[part].placed);
  }
}

void check_updated(const Culling& culling, const TickView& view) noexcept {
  if (!costly) return;
  CLEARANCE_INVARIANT(culling.updated().size() <= culling.known_pairs().known());
  for (const std::uint32_t pair : culling.updated()) {
    CLEARANCE_INVARIANT(is_known(pair, view) && is_carried(pair, view));
    CLEARANCE_INVARIANT(view.pairs.entries[pair].least_lower <= upper_of(pair, view.pairs));
  }
}

// The four counts were computed as differences: a negative one would exceed the total.
void check_report(const Report& report, double most_error) noexcept {
  if constexpr (!kInvariantsChecked) return;
  const std::uint64_t counted = std::uint64_t{report.evaluated} + report.carried + report.stale +
                                report.unknown + absent_pairs(report);
  CLEARANCE_INVARIANT(counted == report.pairs_total);
  CLEARANCE_INVARIANT(report.swept_lower_all <= report.lower_all);
  CLEARANCE_INVARIANT(!report.minimum_certified || report.minimum_known);
  CLEARANCE_INVARIANT(!report.minimum_known || report.lower_all <= report.minimum.lower);
  CLEARANCE_INVARIANT(!report.minimum_certified ||
                      report.lower_all >= report.minimum.lower - kTightGap - 2.0 * most_error);
  CLEARANCE_INVARIANT(report.oldest_evaluation_cycles <= report.cycle);
  if (!costly) return;
  check_zones(report.zones);
  check_separations(report.separated_pairs);
  for (const RobotStop& stop : report.stops)
    CLEARANCE_INVARIANT(stop.scaling >= 0.0 && stop.scaling <= 1.0 && stop.share <= 1.0);
}

}  // namespace clearance
