// §5.3: an ellipsoid as a polyhedron around it, whose facets have the normals of a facet-ball, and
// DQP3 on two of them.
#pragma once

#include <vector>

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "tools/bench/crossed_ellipsoids.hpp"
#include "tools/bench/thesis/variant_loop.hpp"

namespace clearance::bench {

// The outward normals of the thesis's facet-ball: rings around the x-axis. Every other ring is
// rotated by half a facet (tools/bench/bodies.hpp rotates none). All normals are reversed, because
// the thesis's rows point inwards. Order 15 has 288.
[[nodiscard]] std::vector<Vec3> facet_ball_directions(int order);

// Facets touch the ellipsoid: their offsets are the support function (5.3.2).
[[nodiscard]] ConvexBody ellipsoid_model(const Vec3& axes, int order);

// The pair's models, made before any query.
class FacetBallPair {
 public:
  FacetBallPair(const EllipsoidPair& pair, int order);

  [[nodiscard]] std::size_t facets() const { return a_.facets.size() + b_.facets.size(); }
  [[nodiscard]] const ConvexBody& a() const { return a_; }
  [[nodiscard]] const ConvexBody& b() const { return b_; }
  // The next query starts from the centres.
  void forget() { tracking_ = {}; }
  // The thesis's iteration (base), alpha over all facets as it had it, or over the neighbours.
  template <Scan kScan>
  [[nodiscard]] ClosestPoints closest(const Vec3& apart) {
    RelativePose a_from_b;
    a_from_b.rotation.setIdentity();
    a_from_b.translation = apart;
    ActiveFeature a(a_, nullptr), b(b_, &a_from_b);
    if (!a.place_tracked(tracking_.a)) a.place_inside(a_.interior);
    if (!b.place_tracked(tracking_.b)) b.place_inside(b_.interior);
    const LoopEnd end = dqp3_variant<Release::kBase, kScan>(a, b);
    tracking_ = {a.tracked(), b.tracked()};
    return {a.point_A(), b.point_A(), end.cycles, end.ok};
  }

 private:
  ConvexBody a_, b_;
  TrackingState tracking_;
};

}  // namespace clearance::bench
