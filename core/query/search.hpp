// What the walk leaves open: the active-set iteration, GJK in double-double arithmetic, the
// penetration depth (core/README.md).
#pragma once

#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// Whether a pose says where a body is.
[[nodiscard]] bool is_a_place(const RelativePose& pose) noexcept;
// The answer where it does not.
[[nodiscard]] DistanceResult nothing_known() noexcept;

// Adds the spheres' radii to an answer about the polyhedra. Of lengths that overflowed nothing is
// known.
void finish(const ConvexPolyhedron& a, const ConvexPolyhedron& b, DistanceResult& result) noexcept;

// distance() by the active-set iteration from the features of the state on, and where that
// certifies too little by GJK; if `depth`, of bodies that penetrate each other by the penetration
// depth as well.
[[nodiscard]] DistanceResult by_search(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                       const RelativePose& a_from_b, TrackingState& state,
                                       bool depth) noexcept;

// distance() of bodies that penetrated each other in the last query.
[[nodiscard]] DistanceResult by_depth(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                      const RelativePose& a_from_b, TrackingState& state) noexcept;

}  // namespace clearance
