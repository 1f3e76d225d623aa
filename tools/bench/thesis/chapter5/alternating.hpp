// §5.2: the point of A nearest to that of B, the point of B nearest to that of A, and so on.
#pragma once

#include "tools/bench/crossed_ellipsoids.hpp"
#include "tools/bench/thesis/chapter5/nearest_point.hpp"

namespace clearance::bench {

using NearestPointMethod = NearestPoint<3>(const Vec3& axes, const Vec3& p);

enum class Turns {
  kInTurn,    // each moves to where the other has just moved, as §5.2 says
  kTogether,  // both move to where the other was, as the thesis's program has it: twice the rounds
};

// Starts from A's centre, or from `start`. Ends after `most_rounds` rounds, or when the points do
// not move any more.
[[nodiscard]] ClosestPoints alternate(const EllipsoidPair& pair, NearestPointMethod* nearest,
                                      int most_rounds, Turns turns = Turns::kInTurn);
[[nodiscard]] ClosestPoints alternate_from(const ClosestPoints& start, const EllipsoidPair& pair,
                                           NearestPointMethod* nearest, int most_rounds,
                                           Turns turns = Turns::kInTurn);

}  // namespace clearance::bench
