// Bounds of a single pair that queries without a budget make closer, after the tick.
#include <algorithm>
#include <limits>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/pairs/evaluate_pair.hpp"
#include "monitor/tick/monitor.hpp"
#include "monitor/tick/monitor_state.hpp"

namespace clearance {

PairReport Monitor::pair_at_least(std::uint32_t pair, double level) const noexcept {
  const State& s = *state_;
  PairReport report = s.pair_report(pair);
  if (!is_known(report.status) || report.lower >= level) return report;
  const TickView view = s.view();
  const PairEntry& entry = view.pairs.entries[pair];
  const double unobserved = rounded_up(view.objects[entry.object_a].may_have_moved +
                                       view.objects[entry.object_b].may_have_moved);
  const DistanceBounds found = queried_bounds(pair, level, view);
  report.lower = std::max(report.lower, rounded_down(found.lower - unobserved));
  report.upper =
      std::max(report.lower, std::min(report.upper, rounded_up(found.upper + unobserved)));
  report.distance = std::min(std::max(report.distance, report.lower), report.upper);
  return report;
}

SweptBounds Monitor::sweep(std::uint32_t pair, double level) const noexcept {
  const State& s = *state_;
  const PairBounds known = s.bounds(pair);
  SweptBounds bounds{known.swept_lower, known.swept_upper};
  if (!is_known(known.status) || bounds.lower >= level) return bounds;
  Budget unlimited(std::numeric_limits<std::uint32_t>::max());
  const SweptBounds found = swept_bounds_of(pair, level, s.view(), unlimited);
  bounds.lower = std::max(bounds.lower, found.lower);
  bounds.upper = std::min(bounds.upper, found.upper);
  return bounds;
}

}  // namespace clearance
