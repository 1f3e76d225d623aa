#include "monitor/conclude.hpp"

#include <algorithm>

namespace clearance {

void write_pair(std::uint32_t pair, const PairBounds& bounds, const Scheduler& scheduler,
                const Culling& culling, const Evaluation& evaluation, PairReport& report) noexcept {
  report_on(pair, bounds, evaluation.objects, evaluation.parts, evaluation.table, report);
  report.refresh_age_cycles =
      evaluation.cycle - scheduler.refreshed_cycle(pair, culling, evaluation.table);
}

PairBounds bounds_in_tick(std::uint32_t pair, SweptPrecision precision,
                          const ZoneCrossings& crossings, const Evaluation& evaluation) noexcept {
  PairBounds bounds = bounds_of(pair, evaluation.objects, evaluation.parts, evaluation.cycle,
                                evaluation.table, precision);
  if (!crossings.any()) return bounds;
  const SweptBounds swept = crossings.of(pair);
  bounds.swept_lower = std::min(bounds.lower, std::max(bounds.swept_lower, swept.lower));
  bounds.swept_upper = std::min(bounds.swept_upper, swept.upper);
  return bounds;
}

// The bounds of every pair that was looked at are put together once, and all that needs them has
// them at once: a second pass over the published pairs costs a small tick a twentieth of its time.
void conclude(const Published& published, const Displacements& displaced, const Culling& culling,
              const Scheduler& scheduler, const ZoneLevels& levels, const ZoneCrossings& crossings,
              const Evaluation& evaluation, Zones& zones, Conclusion& conclusion,
              std::span<PairReport> reports) noexcept {
  conclusion = {};
  const auto add = [&](std::uint32_t pair, const PairBounds& bounds) {
    conclusion.minimum.add(pair, bounds);
    zones.add(pair, bounds);
    conclusion.evaluated += is_evaluated(bounds.status);
  };
  for (std::size_t i = 0; i < published.pairs.size(); ++i) {
    const std::uint32_t pair = published.pairs[i];
    const PairBounds bounds =
        bounds_in_tick(pair, SweptPrecision::kByRelativeDisplacement, crossings, evaluation);
    write_pair(pair, bounds, scheduler, culling, evaluation, reports[i]);
    if (evaluation.table.entries[pair].carried_cycle == evaluation.cycle) add(pair, bounds);
  }
  for (const std::uint32_t pair : culling.seen()) {
    if (published.is_published[pair]) continue;
    // How near a pair in no zone came matters to the least of all only: a coarse bound will do.
    const auto precision = levels.has(pair) ? SweptPrecision::kByRelativeDisplacement
                                            : SweptPrecision::kByDisplacement;
    add(pair, bounds_in_tick(pair, precision, crossings, evaluation));
  }

  const UnseenPairs unseen = culling.unseen(displaced);
  if (unseen.any) conclusion.minimum.add_rest(unseen.all().now, unseen.all().since);
  const std::span<const TrackedObject> objects(evaluation.objects);
  zones.finish(displaced.any_lost ? objects : objects.first(0), unseen.waiting(), evaluation.cycle);
  zones.explain(objects);
}

}  // namespace clearance
