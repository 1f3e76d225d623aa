// The standard test of chapter 5: crossed ellipsoids of semi-axes [1 2 5] and [5 2 1], with B's
// centre at [4 4 4]. Further tests move B along the line of the closest points (§5.2). These then
// stay where they are on the bodies.
#pragma once

#include "core/vec.hpp"

namespace clearance::bench {

// Both frames are parallel and A is at the origin, as in the thesis. A caller rotates a body
// itself.
struct EllipsoidPair {
  Vec3 axes_a, axes_b;
  Vec3 apart;  // from A's centre to B's
};

// The closest points that an iteration ended with, in A's frame.
struct ClosestPoints {
  Vec3 on_a, on_b;
  int rounds = 0;
  bool converged = true;
  [[nodiscard]] double distance() const { return (on_b - on_a).norm(); }
};

// The error (5.2.1) over all six coordinates.
[[nodiscard]] double x_error(const ClosestPoints& found, const ClosestPoints& truth);

inline constexpr double kSeparations[] = {0.001, 0.1, 0.5, 1.2955, 5.0};
// Stands for the test itself, whose distance is 1.29549481993874080913966969921.
inline constexpr double kStandard = 1.2955;

[[nodiscard]] EllipsoidPair crossed_pair(double separation);

}  // namespace clearance::bench
