#include "tools/bench/crossed_ellipsoids.hpp"

#include <cmath>

namespace clearance::bench {

double x_error(const ClosestPoints& found, const ClosestPoints& truth) {
  return std::hypot((found.on_a - truth.on_a).norm(), (found.on_b - truth.on_b).norm());
}

EllipsoidPair crossed_pair(double separation) {
  EllipsoidPair pair{{1.0, 2.0, 5.0}, {5.0, 2.0, 1.0}, Vec3::Constant(4.0)};
  if (separation == kStandard) return pair;
  // The vector from A's closest point to B's in the test itself: the right digits of (5.2.2), which
  // is right to 5e-11.
  const Vec3 between = Vec3(0.57355555508839, 2.56948358390004, 3.86294222220354) -
                       Vec3(0.13705777779646, 1.43051641609996, 3.42644444491161);
  pair.apart += (separation / between.norm() - 1.0) * between;
  return pair;
}

}  // namespace clearance::bench
