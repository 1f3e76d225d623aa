// What both ends of the way from one tick to the next tell of what lies between.
// monitor/swept/README.md has the motion that is meant, and the proofs.
#pragma once

#include "core/vec.hpp"

namespace clearance {

// At least as far apart all the way, m: bounds of the distance at its ends, and what both bodies
// have moved by, that way and on from any point of it. -infinity where the displacement is.
[[nodiscard]] double lower_by_ends(double before, double now, double displacement) noexcept;

// What an evaluation told: `lower`, m, along `normal` (world, A to B), for the exact poses of then.
// -infinity: no direction separated the bodies.
struct Separated {
  const Vec3& normal;
  double lower;
};

// The same from the directions of evaluations at both ends; -infinity: they do not tell. `bend`:
// at no instant was a point farther than this from where it would be had it gone straight and
// evenly from its place at one end to that at the other, m, both bodies together.
[[nodiscard]] double lower_by_directions(const Separated& before, const Separated& now,
                                         double displacement, double bend) noexcept;

}  // namespace clearance
