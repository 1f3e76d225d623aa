// Bounds for every known pair that a tick did not update. No other file states them.
//
// After the broad phase every known pair is one of three:
//   updated: its bounds are of this tick (Culling::updated());
//   culled:  D - U >= H and Z, also at every instant since the last tick (BROAD_PHASE.md);
//   waiting: only D >= W, because one tick had more motion than time for all pairs.
// D is the pair's distance for the poses in use, and H is the horizon. Z is the level that the
// pair's zones watch for, and U is the unobserved motion of its objects. W is the bound of all
// pairs that wait.
#pragma once

#include <algorithm>

#include "monitor/bodies/directed_rounding.hpp"
#include "monitor/zones/zone_hysteresis.hpp"

namespace clearance {

struct UntouchedPairs {
  bool any = false;                  // a pair is culled or waiting
  double horizon = -kInfinity;       // H, m
  double waiting_lower = kInfinity;  // W, m; infinity: no pair waits
  // Both are the largest sum over any two objects, m. The first sums unobserved motion. The
  // second sums how far the objects were, at any instant since the last tick, from where they are
  // now.
  double most_unobserved = 0.0, most_displaced = 0.0;

  // Lower bounds of distances, for all places where the objects may be; margins are not subtracted.
  // This one is for the pairs that wait, which may be in zones.
  [[nodiscard]] Clearance waiting() const noexcept { return less_motion(waiting_lower); }
  // This one is for all culled and waiting pairs. The horizon holds for each pair with its own
  // unobserved motion: one object that is late, as each camera is, makes no other pair's bound
  // wide.
  [[nodiscard]] Clearance all() const noexcept {
    const Clearance waits = waiting();
    // A discontinuity has no path: its object may have been anywhere since the last tick.
    const double between = most_displaced < kInfinity ? horizon : -kInfinity;
    return {.now = std::min(horizon, waits.now), .since = std::min(between, waits.since)};
  }

 private:
  [[nodiscard]] Clearance less_motion(double lower) const noexcept {
    if (lower == kInfinity) return {};
    return {.now = rounded_down(lower - most_unobserved),
            .since = rounded_down(lower - most_displaced)};
  }
};

}  // namespace clearance
