// The features of test::cube() by their positions, and a body of a query with such a feature
// active.
#pragma once

#include <stdexcept>

#include "core/active_set/active_feature.hpp"

namespace clearance::test {

// The facet with this outward normal.
[[nodiscard]] inline std::int32_t facet_towards(const ConvexBody& body, const Vec3& normal) {
  for (std::size_t i = 0; i < body.facets.size(); ++i) {
    if (body.facets[i].normal == normal) return static_cast<std::int32_t>(i);
  }
  throw std::logic_error("no facet with this normal");
}

// The edge with this midpoint.
[[nodiscard]] inline std::int32_t edge_around(const ConvexBody& body, const Vec3& middle) {
  for (std::size_t i = 0; i < body.edges.size(); ++i) {
    const Edge& edge = body.edges[i];
    if (edge.point + 0.5 * edge.end * edge.direction == middle) {
      return static_cast<std::int32_t>(i);
    }
  }
  throw std::logic_error("no edge around this point");
}

[[nodiscard]] inline std::int32_t vertex_at(const ConvexBody& body, const Vec3& position) {
  for (std::size_t i = 0; i < body.vertices.size(); ++i) {
    if (body.vertices[i].position == position) return static_cast<std::int32_t>(i);
  }
  throw std::logic_error("no vertex at this point");
}

// A body whose point in its local frame is `own`, on the feature of this kind and index.
[[nodiscard]] inline ActiveFeature active(const ConvexBody& body, const RelativePose* pose,
                                          FeatureKind kind, std::int32_t index, const Vec3& own) {
  ActiveFeature side(body, pose);
  side.place(kind, index, own);
  return side;
}

// A body's feature of this kind, at a point inside the feature. `which` is the index, modulo the
// number of such features.
[[nodiscard]] inline ActiveFeature active(const ConvexBody& body, const RelativePose* pose,
                                          FeatureKind kind, int which) {
  const auto index = [&](const auto& all) {
    return static_cast<std::int32_t>(static_cast<std::size_t>(which) % all.size());
  };
  if (kind == FeatureKind::kVertex) {
    const std::int32_t i = index(body.vertices);
    return active(body, pose, kind, i, body.vertices[i].position);
  }
  if (kind == FeatureKind::kEdge) {
    const std::int32_t i = index(body.edges);
    const Edge& edge = body.edges[i];
    return active(body, pose, kind, i, edge.point + 0.4 * edge.end * edge.direction);
  }
  if (kind == FeatureKind::kFacet) {
    const std::int32_t i = index(body.facets);
    const Facet& facet = body.facets[i];
    Vec3 middle = Vec3::Zero();
    for (std::int32_t k = 0; k < facet.sides; ++k) {
      const Edge& edge = body.edges[body.facet_edges[facet.first_side + k].edge];
      middle += (edge.point + 0.5 * edge.end * edge.direction) / facet.sides;
    }
    return active(body, pose, kind, i, middle);
  }
  return active(body, pose, FeatureKind::kInside, kNone, body.interior);
}

}  // namespace clearance::test
