// Bounds of the distance between two ticks, from what is known at both of them.
// monitor/swept/README.md has the motion that is meant, and the proofs.
#pragma once

#include "core/vec.hpp"

namespace clearance {

// The distance was at least this between two ticks, m, by lower bounds of the distance at both, and
// the displacement of both bodies by any pose in between. -infinity where the displacement is
// infinite.
[[nodiscard]] double lower_by_ends(double before, double now, double displacement) noexcept;

// The result of an evaluation: for the exact poses of its tick the bodies were at least `lower`, m,
// from each other along `normal` (world, A to B). -infinity: no direction separated them.
struct Separated {
  const Vec3& normal;
  double lower;
};

// The same by the directions of evaluations in both ticks; -infinity: they prove nothing. `bend`,
// m, is that of both bodies together (bend_at_most()).
[[nodiscard]] double lower_by_directions(const Separated& before, const Separated& now,
                                         double displacement, double bend) noexcept;

}  // namespace clearance
