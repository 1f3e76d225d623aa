// A curved body without the radius around it: an ellipsoid, or a truncated cone, which may be a
// cylinder or a cone.
#pragma once

#include <array>
#include <cstdint>

#include "core/vec.hpp"

namespace clearance {

// x^2 + y^2 <= radius^2 in the plane z = height; with radius 0 it is a point.
struct Disc {
  double height = 0.0, radius = 0.0;  // m
  [[nodiscard]] bool operator==(const Disc&) const noexcept = default;
};

struct CurvedShape {
  enum class Kind : std::uint8_t { kNone, kEllipsoid, kTruncatedCone };

  Kind kind = Kind::kNone;        // kNone: the body is a polyhedron
  Vec3 semi_axes = Vec3::Zero();  // of an ellipsoid around the origin, along the frame's axes, m
  // The discs of a truncated cone around the z-axis, the lower one first; the cone is their hull.
  std::array<Disc, 2> discs;

  [[nodiscard]] bool operator==(const CurvedShape&) const noexcept = default;
};
static_assert(sizeof(CurvedShape) == 64 && alignof(CurvedShape) == 8);

}  // namespace clearance
