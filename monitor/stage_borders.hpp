// What must hold where one stage of the tick ends and the next begins: the checks that read what
// several rooms have written. Those of a single room stand in its own code.
#pragma once

#include <span>

#include "monitor/broad_phase/culling.hpp"
#include "monitor/objects/displacements.hpp"
#include "monitor/report.hpp"

namespace clearance {

// Whether this build checks them at all (CLEARANCE_INVARIANTS).
[[nodiscard]] bool stage_borders_are_checked() noexcept;

// Checks below marked 'costly' are off, because a small tick feels them (3 % of 3.2 us). They are
// on in Debug and sanitizer builds, and in the tests, which call this before the first tick.
void check_costly_borders() noexcept;

// Costly. After 'displace' and 'pose': objects that changed have usable poses, sums that never
// decrease, and placed parts. `first_part`: by object, index into the parts.
void check_displaced(std::span<const std::uint32_t> changed,
                     std::span<const std::uint32_t> first_part, const TickView& view) noexcept;

// Costly. After 'cull': the updated pairs are known, and their bounds are of this tick and in
// order.
void check_updated(const Culling& culling, const TickView& view) noexcept;

// After 'report': its totals and its minimum agree with each other. Costly: so do its zones and
// separations.
void check_report(const Report& report) noexcept;

}  // namespace clearance
