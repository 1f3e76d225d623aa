// Checks of the tick's invariants where one stage ends and the next begins. They read the results
// of several rooms. Checks of a single room are in its own code.
#pragma once

#include <span>

#include "monitor/bodies/displacements.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/schedule/culling.hpp"

namespace clearance {

// True if this build checks stage borders at all (CLEARANCE_INVARIANTS).
[[nodiscard]] bool stage_borders_are_checked() noexcept;

// Turns on the checks marked 'costly' below. They are off by default, because they cost a small
// tick 3 % of its 3.2 us. They are on in Debug and sanitizer builds, and in tests, which call this
// before the first tick.
void check_costly_borders() noexcept;

// Costly. After 'displace' and 'pose': changed objects have usable poses, sums that never decrease,
// and placed parts. `first_part`, by object, is an index into the parts.
void check_displaced(std::span<const std::uint32_t> changed,
                     std::span<const std::uint32_t> first_part, const TickView& view) noexcept;

// Costly. After 'cull': the updated pairs are known, and their bounds are ordered and belong to
// this tick.
void check_updated(const Culling& culling, const TickView& view) noexcept;

// After 'report': its totals and its minimum agree with each other. Costly part: its zones and
// separations agree, too. `most_error`: no stated error changes a distance by more, m. Within it,
// another pair may be nearer than the certified minimum, and have the wider bounds.
void check_report(const Report& report, double most_error = 0.0) noexcept;

}  // namespace clearance
