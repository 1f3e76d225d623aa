// From bounds of the bodies without their radii to the answer.
#pragma once

#include "core/distance_result.hpp"

namespace clearance {

struct CurvedConclusion {
  double lower = -kInfinity, upper = kInfinity;  // signed, as computed
  double error = 0.0;                            // m: neither bound is off by more
  double size = 0.0;                             // m: of the bodies and what is between them
  double radius_a = 0.0, radius_b = 0.0;         // m
  Vec3 normal = Vec3::Zero();                    // unit, from A to B; this and the points: frame A
  Vec3 point_on_a = Vec3::Zero(), point_on_b = Vec3::Zero();  // on the bodies without radii
};

// From A to B as radii are put on: along the points where the bodies without radii are apart, so
// that what is left of the witness points is as long as the distance.
[[nodiscard]] Vec3 radial_direction(const CurvedConclusion& found) noexcept;

// Bounds that have converged are within this of each other, by the pair's size.
inline constexpr double kConvergedCurvedGap = 1e-13;

// A point of both bodies where their radii make them overlap, as the points say.
[[nodiscard]] Vec3 between(const Vec3& on_a, const Vec3& on_b, double radius_a,
                           double radius_b) noexcept;

[[nodiscard]] DistanceResult conclude(const CurvedConclusion& found) noexcept;

}  // namespace clearance
