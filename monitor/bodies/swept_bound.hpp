// Lower bounds of the distance between two ticks, from bounds at both of them.
// monitor/schedule/SWEPT.md has the assumed motion and the proofs.
#pragma once

#include "core/vec.hpp"

namespace clearance {

// A lower bound of the distance at any instant between two ticks, m. `before` and `now` are lower
// bounds at the two ticks. `displacement` bounds that of both bodies together, by any pose in
// between. The result is -infinity if the displacement is infinite.
[[nodiscard]] double lower_by_ends(double before, double now, double displacement) noexcept;

// The result of an evaluation. For the exact poses of its tick, the bodies were at least `lower`,
// m, from each other along `normal` (world, A to B). It is -infinity if no direction separated
// them.
struct Separated {
  const Vec3& normal;
  double lower;
};

// The same bound from the separating directions of evaluations in both ticks; -infinity if they
// prove nothing. `bend`, m, is the sum of bend_at_most() of both bodies.
[[nodiscard]] double lower_by_directions(const Separated& before, const Separated& now,
                                         double displacement, double bend) noexcept;

}  // namespace clearance
