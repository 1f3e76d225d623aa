// The distance of a body from a half-space, signed: one support point decides it.
#pragma once

#include "core/curved/curved_body.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

[[nodiscard]] bool is_half_space(const CurvedBody& body) noexcept;

// A or B is a half-space, the other one is bounded. `shared`: as of CurvedTrackingState.
[[nodiscard]] DistanceResult distance_of_half_space(const CurvedBody& a, const CurvedBody& b,
                                                    const RelativePose& a_from_b,
                                                    Vec3& shared) noexcept;

}  // namespace clearance
