// Distance queries, which narrow a pair's bounds to rounding where the budget allows.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/pairs/budget.hpp"
#include "monitor/pairs/tick_view.hpp"

namespace clearance {

// Takes in the answer to a query of a pair's only part pair, which brings the pair up to date.
// `point_on_b` is the witness point on B in B's local frame (TrackingState). Does not count the
// query.
void settle(std::uint32_t pair, const DistanceResult& found, const Vec3& point_on_b,
            const OpenTick& tick) noexcept;

// The bounds of a query are for the poses as the query used them, in doubles. These are for the
// exact poses.
[[nodiscard]] DistanceBounds for_exact_poses(const DistanceResult& found, const PosedPart& a,
                                             const PosedPart& b) noexcept;

// Brings a pair up to date and evaluates it as far as the budget goes. The part pair that may be
// closest is first, then every other one that may be closer still. A part pair whose carried bounds
// prove that it is not the closest is not queried: the pair's distance does not depend on it. Both
// objects are known, and the budget has a query left.
void evaluate_pair(std::uint32_t pair, const OpenTick& tick, Budget& budget) noexcept;

// Returns bounds of a pair's distance at the poses of this tick, as far as queries are needed to
// decide whether it is at least `level`, m. Changes no bound of the table, and needs no budget.
[[nodiscard]] DistanceBounds queried_bounds(std::uint32_t pair, double level,
                                            const TickView& view) noexcept;

// Evaluates different pairs in their order while the budget has queries left, and returns how many.
// None of them was evaluated in this tick before.
std::size_t evaluate_pairs(std::span<const std::uint32_t> pairs, const OpenTick& tick,
                           Budget& budget) noexcept;

}  // namespace clearance
