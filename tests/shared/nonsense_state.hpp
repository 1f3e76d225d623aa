// Tracking states that no query has left behind.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/distance.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// Features that the body may not have; points anywhere up to where squares overflow and beyond.
[[nodiscard]] inline TrackingState::Side nonsense_side(const ConvexPolyhedron& body,
                                                       Random& random) {
  TrackingState::Side out;
  out.dimension = static_cast<std::uint8_t>(random.integer(0, 6));
  const std::size_t most = std::max({body.facets.size(), body.edges.size(), body.vertices.size()});
  out.feature = random.integer(-2, static_cast<int>(most) + 1);
  out.point = random.in_box(random.log_uniform(1e-3, random.chance(0.7) ? 1e18 : 1e307));
  if (random.chance(0.1)) out.point.x() = std::nan("");
  if (random.chance(0.1)) out.point.y() = kInfinity;
  return out;
}

[[nodiscard]] inline TrackingState nonsense_state(const ConvexPolyhedron& a,
                                                  const ConvexPolyhedron& b, Random& random) {
  TrackingState out{nonsense_side(a, random), nonsense_side(b, random)};
  out.a.deep = random.chance(0.5);
  return out;
}

}  // namespace clearance::test
