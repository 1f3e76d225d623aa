// Tracking states that no query has produced.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/distance.hpp"
#include "tests/shared/random.hpp"

namespace clearance::test {

// Features that the body may not have, and points of any magnitude, including those whose squares
// overflow.
[[nodiscard]] inline TrackingState::Side nonsense_side(const ConvexBody& body, Random& random) {
  TrackingState::Side out;
  out.kind = static_cast<FeatureKind>(random.integer(0, 6));
  const std::size_t most = std::max({body.facets.size(), body.edges.size(), body.vertices.size()});
  out.feature = random.integer(-2, static_cast<int>(most) + 1);
  out.point = random.in_box(random.log_uniform(1e-3, random.chance(0.7) ? 1e18 : 1e307));
  if (random.chance(0.1)) out.point.x() = std::nan("");
  if (random.chance(0.1)) out.point.y() = kInfinity;
  return out;
}

[[nodiscard]] inline TrackingState nonsense_state(const ConvexBody& a, const ConvexBody& b,
                                                  Random& random) {
  TrackingState out{nonsense_side(a, random), nonsense_side(b, random)};
  out.a.penetrating = random.chance(0.5);
  return out;
}

// Any feature of the body and a point on it, or no feature.
[[nodiscard]] inline TrackingState::Side other_side(const ConvexBody& body, Random& random) {
  TrackingState::Side out;
  const int dimension = random.integer(0, 2);
  const auto count = static_cast<int>(body.features[static_cast<std::size_t>(dimension)]);
  if (count == 0) return out;
  out.kind = static_cast<FeatureKind>(dimension);
  out.feature = random.integer(0, count - 1);
  const auto on_edge = [&](const Edge& edge) -> Vec3 {
    const double from = std::max(edge.begin, -10.0), to = std::min(edge.end, 10.0);
    return edge.point + random.uniform(from, to) * edge.direction;
  };
  if (dimension == 0) out.point = body.vertices[out.feature].position;
  if (dimension == 1) out.point = on_edge(body.edges[out.feature]);
  if (dimension == 2) {
    const Facet& facet = body.facets[out.feature];
    out.point = body.point_of(facet);
    if (facet.sides == 0) return out;
    const int side = facet.first_side + random.integer(0, facet.sides - 1);
    const Vec3 at_side = on_edge(body.edges[body.facet_edges[side].edge]);
    out.point += random.unit() * (at_side - out.point);
  }
  return out;
}

// A state of the same bodies in another pose.
[[nodiscard]] inline TrackingState other_state(const ConvexBody& a, const ConvexBody& b,
                                               Random& random) {
  TrackingState out{other_side(a, random), other_side(b, random)};
  out.a.penetrating = random.chance(0.3);
  return out;
}

}  // namespace clearance::test
