// §5.5.2: DQP3 on facet-balls first, alternating points (§5.2) from where it ends.
#pragma once

#include "tools/bench/thesis/chapter5/alternating.hpp"
#include "tools/bench/thesis/chapter5/facet_ball.hpp"
#include "tools/bench/thesis/chapter5/safeguarded_newton.hpp"

namespace clearance::bench {

inline constexpr int kHybridOrder = 6;  // the thesis's

[[nodiscard]] inline ClosestPoints hybrid(FacetBallPair& models, const EllipsoidPair& pair,
                                          int most_rounds) {
  models.forget();
  const ClosestPoints coarse = models.closest<Scan::kNeighbours>(pair.apart);
  return alternate_from(coarse, pair, nearest_by_newton<3>, most_rounds);
}

}  // namespace clearance::bench
