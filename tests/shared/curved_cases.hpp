// Pairs of curved bodies that are hard for a distance algorithm. A seed gives the same pair on
// every platform.
//
// The families contain aspect ratios up to 1 : 10^4, discs, needles, parallel caps, common axes and
// rims that meet. They also contain apexes, tilts from 1e-14 to 1e-3, concentric and nearly
// spherical bodies, and polyhedra. All pairs of kinds occur, with and without radii.
#pragma once

#include <span>

#include "core/shapes.hpp"
#include "tests/shared/curved_oracle.hpp"
#include "tests/shared/random.hpp"

namespace clearance::hard {

struct CurvedCase {
  oracle::CurvedBody a, b;
  Pose pose_a, pose_b;

  [[nodiscard]] oracle::PlacedCurvedBody placed_a() const { return {&a, pose_a}; }
  [[nodiscard]] oracle::PlacedCurvedBody placed_b() const { return {&b, pose_b}; }
};

struct CurvedFamily {
  const char* name;
  CurvedCase (*make)(Random&);
};

[[nodiscard]] std::span<const CurvedFamily> curved_families();

// A cone around z whose radii are `low` and `high` at the heights -half_length and half_length, m.
[[nodiscard]] oracle::CurvedBody truncated_cone_of(double low, double high, double half_length);
// A box around the origin with these half lengths, m.
[[nodiscard]] oracle::CurvedBody box_of(const Vec3& half);
[[nodiscard]] oracle::CurvedBody ellipsoid_of(const Vec3& semi_axes);

// The core's model of a body, or the reason for its refusal.
[[nodiscard]] ShapeResult curved_model(const oracle::CurvedBody& body);

}  // namespace clearance::hard
