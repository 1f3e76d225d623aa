// Is the distance of a pair differentiable, or is its gradient one of several?
//
// The gradient is that of the closest points. It is unique if they are. Two objects have a second
// pair of closest points if another pair of their parts is as close. Two disjoint polyhedra have
// several if both extend along one line at right angles to the normal, as parallel faces do. A
// rotation about the normal or about that line moves all of its points alike, so it only matters if
// a joint turns the pair about the third axis.
#pragma once

#include <span>

#include "monitor/interface/report.hpp"
#include "monitor/pairs/tick_view.hpp"

namespace clearance {

// No rates, and nothing known of them.
[[nodiscard]] GradientAlternative unknown_alternative() noexcept;

// The pair must have been evaluated in this tick. `turns` are the angular velocities, in the world,
// by which the pair's joints turn one object relative to the other. Allocates nothing.
[[nodiscard]] GradientAlternative alternative_of(const PairReport& pair,
                                                 std::span<const Vec3> turns,
                                                 const TickView& view) noexcept;

// The closest points of two parts that are placed, in the world. The normal leads from A to B.
struct Contact {
  Vec3 witness_a, witness_b, normal;
};

// GradientAlternative::tilt. NaN if a part is curved, or unbounded without being a half-space.
[[nodiscard]] double tilt_of(const PosedPart& a, const PosedPart& b, const Contact& contact,
                             std::span<const Vec3> turns) noexcept;

}  // namespace clearance
