// What must hold where one stage of the tick ends and the next begins: the checks that read what
// several rooms have written. Those of a single room stand in its own code.
#pragma once

#include <span>

#include "monitor/broad_phase/culling.hpp"
#include "monitor/objects/displacements.hpp"
#include "monitor/report.hpp"

namespace clearance {

// Whether this build checks them (CLEARANCE_INVARIANTS).
[[nodiscard]] bool stage_borders_are_checked() noexcept;

// After 'displace' and 'pose': objects that changed have usable poses, sums that never decrease,
// and placed parts. `first_part`: by object, index into the parts.
void check_displaced(std::span<const std::uint32_t> changed,
                     std::span<const std::uint32_t> first_part, const TickView& view) noexcept;

// After 'cull': the updated pairs are known, and their bounds are of this tick and in order.
void check_updated(const Culling& culling, const TickView& view) noexcept;

// After 'report': its totals, its minimum, its zones and its separations agree with each other.
void check_report(const Report& report) noexcept;

}  // namespace clearance
