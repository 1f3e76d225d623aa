#include "core/construction/centre.hpp"

#include <algorithm>
#include <cmath>

#include "core/construction/integer_vector.hpp"

namespace clearance::exact {
namespace {

// The least gap to any plane; negative outside one.
double depth(const ConvexBody& body, const Vec3& point) {
  double least = kInfinity;
  for (const Facet& facet : body.facets) {
    least = std::min(least, -facet.normal.dot(point - body.point_of(facet)));
  }
  return least;
}

// The centre of volume, by a fan of tetrahedra from the first vertex. Bounded bodies only.
Vec3 centroid(const ConvexBody& body) {
  const Vec3& apex = body.anchors[0];
  Vec3 moment = Vec3::Zero();
  double volume = 0.0;
  for (const Facet& facet : body.facets) {
    for (std::int32_t i = 0; i < facet.sides; ++i) {
      const Edge& edge = body.edges[at(body.facet_edges[at(facet.first_side + i)].edge)];
      const Vec3 a = body.vertices[at(edge.vertex[0])].position - apex;
      const Vec3 b = body.vertices[at(edge.vertex[1])].position - apex;
      const Vec3 c = body.point_of(facet) - apex;
      const double share = std::abs(c.dot(a.cross(b)));
      volume += share;
      moment += share * (a + b + c);
    }
  }
  return volume > 0.0 ? Vec3(apex + moment / (4.0 * volume)) : apex;
}

// Moves from the mean of the `anchors` along the mean of the rays, by the spread of the `anchors`.
Vec3 beyond_anchors(const ConvexBody& body) {
  Vec3 mean = Vec3::Zero();
  for (const Vec3& anchor : body.anchors) mean += anchor / static_cast<double>(body.anchors.size());
  double spread = 0.0;
  for (const Vec3& anchor : body.anchors) spread = std::max(spread, (anchor - mean).norm());
  if (spread == 0.0) spread = mean.norm();
  if (spread == 0.0) spread = 1.0;
  Vec3 along = Vec3::Zero();
  for (const Ray& ray : body.rays) along += ray.direction.normalized();
  return mean + spread * (along.isZero(0.0) ? along : along.normalized());
}

}  // namespace

Vec3 well_inside(const ConvexBody& body, const Vec3& known) {
  const Vec3 centre = body.bounded() ? centroid(body) : beyond_anchors(body);
  const double reached = depth(body, centre);
  return reached > 0.0 || reached >= depth(body, known) ? centre : known;
}

}  // namespace clearance::exact
