// The distance of a body from a half-space, signed: one support point decides it.
#pragma once

#include "core/curved/curved_distance.hpp"
#include "core/pose.hpp"

namespace clearance {

// A or B is a half-space, the other one is bounded. Writes the state's points.
[[nodiscard]] DistanceResult distance_of_half_space(const ConvexBody& a, const ConvexBody& b,
                                                    const RelativePose& a_from_b,
                                                    CurvedTrackingState& state) noexcept;

}  // namespace clearance
