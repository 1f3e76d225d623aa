#include "monitor/conclude.hpp"

#include <algorithm>

namespace clearance {

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

// Every pair that was looked at is summed up once.
void conclude(std::span<const std::uint32_t> published, std::span<const std::uint8_t> is_published,
              const Displacements& displaced, const Culling& culling, const ZoneLevels& levels,
              const ZoneCrossings& crossings, const Evaluation& evaluation, Zones& zones,
              Conclusion& conclusion) noexcept {
  conclusion.minimum = {};
  conclusion.evaluated = 0;
  const auto add = [&](std::uint32_t pair, const PairBounds& bounds) {
    conclusion.minimum.add(pair, bounds);
    zones.add(pair, bounds);
    conclusion.evaluated += is_evaluated(bounds.status);
  };
  for (std::size_t i = 0; i < published.size(); ++i) {
    PairBounds& bounds = conclusion.published[i];
    bounds = bounds_in_tick(published[i], SweptPrecision::kByRelativeDisplacement, crossings,
                            evaluation);
    const PairEntry& entry = evaluation.table.entries[published[i]];
    if (entry.carried_cycle == evaluation.cycle) add(published[i], bounds);
  }
  for (const std::uint32_t pair : culling.seen()) {
    if (is_published[pair]) continue;
    // Of pairs in no zone nobody asks how near they came, but for the least of all.
    const auto precision = levels.has(pair) ? SweptPrecision::kByRelativeDisplacement
                                            : SweptPrecision::kByDisplacement;
    add(pair, bounds_in_tick(pair, precision, crossings, evaluation));
  }

  const UnseenPairs unseen = culling.unseen(displaced);
  if (unseen.any) conclusion.minimum.add_rest(unseen.all().now, unseen.all().since);
  const std::span<const TrackedObject> objects(evaluation.objects);
  zones.finish(displaced.any_lost ? objects : objects.first(0), unseen.waiting(), evaluation.cycle);
}

}  // namespace clearance
