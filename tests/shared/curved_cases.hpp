// Pairs of curved bodies that are hard for a distance algorithm, from seeds: the same everywhere.
//
// Thin to 1 : 10^4, discs and needles, parallel caps, one axis, rim on rim, an apex, tilts from
// 1e-14 to 1e-3, one centre, nearly spherical, any pair of kinds; rounded or not, and polyhedra.
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

// The core's model of a body, or the reason why it was refused.
[[nodiscard]] ShapeResult curved_model(const oracle::CurvedBody& body);

}  // namespace clearance::hard
