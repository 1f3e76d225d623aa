// How an unbounded body goes on for ever: worked out once, when it is made.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/vec.hpp"

namespace clearance {

struct ConvexPolyhedron;

// The body's directions are sums of its lines, either way along each, and of its other rays.
struct Opening {
  // Unit, at right angles; two of them are a whole plane.
  std::array<Vec3, 2> lines{Vec3::Zero(), Vec3::Zero()};
  std::size_t line_count = 0;
  std::vector<Vec3> rays;  // unit
  // How much of any of the rays, at least, lies along one direction at right angles to the lines;
  // rounding included. 0 or less: no such direction is known.
  double least = 0.0;
  // Unit: a direction in which the body goes on for ever that leads away from every facet; zero:
  // there is none.
  Vec3 inwards = Vec3::Zero();

  // What of v is at right angles to the lines.
  [[nodiscard]] Vec3 across_lines(Vec3 v) const noexcept {
    for (std::size_t i = 0; i < line_count; ++i) v -= v.dot(lines[i]) * lines[i];
    return v;
  }
};

// What rounding may hide of a slope: its direction's, its product's and its sum's.
inline constexpr double kSlopeError = 0x1p-50;

// Sets the body's `opening`.
void add_opening(ConvexPolyhedron& body);

}  // namespace clearance
