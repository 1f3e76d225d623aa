#include "monitor/zone_state.hpp"

#include "monitor/rounding.hpp"

namespace clearance {

void update(const Scene& scene, const Zone& zone, const std::vector<PairSummary>& pairs,
            std::uint64_t cycle, ZoneReport& report) noexcept {
  // A pair is outside when its clearance could neither enter the zone nor keep it active.
  const bool was_active = report.active;
  report.clearance = kInfinity;
  report.proved = true;
  bool first = true;
  for (const std::uint32_t p : zone.pairs) {
    const PairSummary& pair = pairs[p];
    const double margins =
        scene.objects[scene.pairs[p].first].margin + scene.objects[scene.pairs[p].second].margin;
    const double clearance =
        margins > 0.0 ? rounded_down(pair.lower - rounded_up(margins)) : pair.lower;
    const bool outside = was_active ? clearance > zone.leave_above : clearance >= zone.enter_below;
    if (!outside && !is_evaluated(pair.status)) report.proved = false;
    if (first || clearance < report.clearance) {
      report.clearance = clearance;
      report.pair = p;
    }
    first = false;
  }
  report.active =
      was_active ? !(report.clearance > zone.leave_above) : report.clearance < zone.enter_below;
  report.changed = report.active != was_active;
  if (report.changed) report.since_cycle = cycle;
}

}  // namespace clearance
