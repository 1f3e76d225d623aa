#include "monitor/tick/conclude.hpp"

#include <algorithm>

#include "monitor/interface/invariant.hpp"

namespace clearance {

PairBounds bounds_in_tick(std::uint32_t pair, SweptPrecision precision,
                          const ZoneCrossings& crossings, const TickView& view) noexcept {
  PairBounds bounds = bounds_of(pair, view, precision);
  if (crossings.any()) {
    const SweptBounds swept = crossings.of(pair);
    bounds.swept_lower = std::min(bounds.lower, std::max(bounds.swept_lower, swept.lower));
    bounds.swept_upper = std::min(bounds.swept_upper, swept.upper);
  }
  CLEARANCE_INVARIANT(bounds.swept_lower <= bounds.lower && bounds.lower <= bounds.upper);
  return bounds;
}

void judge(const TickView& view, const ZoneCrossings& crossings, Contacts& contacts) noexcept {
  for (std::size_t i = 0; i < contacts.reports().size(); ++i) {
    constexpr auto kClosely = SweptPrecision::kByRelativeDisplacement;
    contacts.judge(i, bounds_in_tick(contacts.pair(i), kClosely, crossings, view), view);
  }
}

// Computes the bounds of every updated pair once, and passes them at once to all that need them. A
// second pass over the published pairs costs a small tick a twentieth of its time.
Conclusion conclude(const Published& published, const Displacements& displaced,
                    const Culling& culling, const ZoneCrossings& crossings, const TickView& view,
                    Zones& zones, std::span<PairReport> reports) noexcept {
  Conclusion conclusion;
  std::size_t updated = 0;
  const auto add = [&](std::uint32_t pair, const PairBounds& bounds) {
    ++updated;
    conclusion.minimum.add(pair, bounds,
                           view.errors == nullptr ? 0.0 : stated_width(pair, bounds, view));
    zones.add(pair, bounds);
    conclusion.evaluated += is_evaluated(bounds.status);
  };
  for (std::size_t i = 0; i < published.pairs.size(); ++i) {
    const std::uint32_t pair = published.pairs[i];
    const PairBounds bounds =
        bounds_in_tick(pair, SweptPrecision::kByRelativeDisplacement, crossings, view);
    write_pair(pair, bounds, view, reports[i]);
    if (is_carried(pair, view)) {
      add(pair, bounds);
    } else {  // published pairs that the broad phase leaves out are carried
      CLEARANCE_INVARIANT(!is_known(pair, view) || !culling.broad_phase().left_out(pair));
    }
  }
  for (const std::uint32_t pair : culling.updated()) {
    CLEARANCE_INVARIANT(is_carried(pair, view));
    if (published.is_published[pair]) continue;
    // The swept bound of a pair in no zone is used only for the minimum of all, so a coarse one
    // suffices.
    const auto precision = zones.watch(pair) ? SweptPrecision::kByRelativeDisplacement
                                             : SweptPrecision::kByDisplacement;
    add(pair, bounds_in_tick(pair, precision, crossings, view));
  }
  // The culling's list contains exactly the pairs whose bounds are of this tick.
  CLEARANCE_INVARIANT(updated == culling.updated().size());

  const UntouchedPairs untouched = culling.untouched(displaced);
  if (untouched.any) conclusion.minimum.add_rest(untouched.all().now, untouched.all().since);
  const std::span<const TrackedObject> objects(view.objects);
  zones.finish(objects, untouched.waiting(), displaced.any_lost, view.cycle);
  zones.explain(objects);
  return conclusion;
}

}  // namespace clearance
