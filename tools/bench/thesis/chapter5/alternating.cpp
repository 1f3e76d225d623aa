#include "tools/bench/thesis/chapter5/alternating.hpp"

#include <cmath>

#include "core/convex_body.hpp"

namespace clearance::bench {

ClosestPoints alternate_from(const ClosestPoints& start, const EllipsoidPair& pair,
                             NearestPointMethod* nearest, int most_rounds, Turns turns) {
  // Steps of a linear convergence shrink until they are rounding, which is somewhere below this
  // share of the semi-axes.
  constexpr double kRounding = 1e-13;
  const double rounding = kRounding * (pair.axes_a.maxCoeff() + pair.axes_b.maxCoeff());
  ClosestPoints at{start.on_a, start.on_b, 0, false};
  double last_step = kInfinity;
  while (at.rounds < most_rounds) {
    ++at.rounds;
    const Vec3 on_b = pair.apart + nearest(pair.axes_b, at.on_a - pair.apart).point;
    const Vec3 on_a = nearest(pair.axes_a, turns == Turns::kInTurn ? on_b : at.on_b).point;
    const double step = std::hypot((on_a - at.on_a).norm(), (on_b - at.on_b).norm());
    at.on_a = on_a;
    at.on_b = on_b;
    if (step <= rounding && step >= last_step) {
      at.converged = true;
      break;
    }
    last_step = step;
  }
  return at;
}

ClosestPoints alternate(const EllipsoidPair& pair, NearestPointMethod* nearest, int most_rounds,
                        Turns turns) {
  return alternate_from({Vec3::Zero(), pair.apart}, pair, nearest, most_rounds, turns);
}

}  // namespace clearance::bench
