// What holds of every known pair that a tick has not looked at: the one place for it.
//
// After the broad phase every known pair is one of three:
//   seen:    its bounds are of this tick (Culling::seen());
//   culled:  D >= H, and D - U >= Z, also at every instant since the last tick (README.md here);
//   waiting: overtaken by so much motion in one tick that there was no time for it: D >= W only.
// D is the pair's distance for the poses in use, H the horizon, Z what the pair's zones watch for,
// U what its objects may have moved unseen.
#pragma once

#include <algorithm>

#include "monitor/motion/directed_rounding.hpp"
#include "monitor/zones/zone_hysteresis.hpp"

namespace clearance {

struct UnseenPairs {
  bool any = false;                  // there is a pair that is culled or waiting
  double horizon = -kInfinity;       // H, m
  double waiting_lower = kInfinity;  // W, m; infinity: no pair waits
  // U of any two objects, and how far any two may have been from where they are now at some instant
  // since the last tick, m.
  double most_unseen = 0.0, most_displaced = 0.0;

  // For where the objects may be, no margins subtracted: of the pairs that wait, which may be in
  // zones; and of all.
  [[nodiscard]] Clearance waiting() const noexcept { return less_motion(waiting_lower); }
  [[nodiscard]] Clearance all() const noexcept {
    return less_motion(std::min(horizon, waiting_lower));
  }

 private:
  [[nodiscard]] Clearance less_motion(double lower) const noexcept {
    if (lower == kInfinity) return {};
    return {.now = rounded_down(lower - most_unseen),
            .since = rounded_down(lower - most_displaced)};
  }
};

}  // namespace clearance
