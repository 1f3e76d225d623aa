// Rimon and Boyd's free margin ("Obstacle collision detection using best ellipsoid fit", J. of
// Intelligent and Robotic Systems 18, 1997), which §5.6 compares. It is not the distance, but the
// factor by which A must be scaled to touch B, from one eigenvalue problem.
#pragma once

#include "tools/bench/crossed_ellipsoids.hpp"

namespace clearance::bench {

struct FreeMargin {
  double margin;  // A grown by this share of itself touches B: 0 if they touch, < 0 if they overlap
  // The point of B where it does, and the point of A nearest to that: their distance is never too
  // small.
  Vec3 touched, nearest;
};

[[nodiscard]] FreeMargin free_margin(const EllipsoidPair& pair);

}  // namespace clearance::bench
