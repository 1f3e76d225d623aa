// One body during a query: its active feature, and its point x on it (§3.3: the active set of one
// object).
//
// The active set is kept as the feature of the polyhedron that it defines. No active facet means
// the inside, one a facet, two an edge, three or more a vertex. All facets that meet in a vertex
// are active there at once. So degenerate vertices need no special treatment (core/README.md). The
// point x lies in the feature. It is kept in the body's local frame, where the body does not move
// (§3.4.4), and in frame A as well.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>

#include "core/model/query.hpp"

namespace clearance {

// The limit of the facet (Facet::limits) that p violates most, by more than `tolerance` (m), by its
// index. kNone: p violates none of them.
[[nodiscard]] std::int32_t crossed_limit(const ConvexBody& body, const Facet& facet, const Vec3& p,
                                         double tolerance = 0.0) noexcept;

// If facets are parallel within rounding, rounding decides on which of their planes a point lies.
// Starts at facet `index`, crosses the edges that p has passed, and returns the facet whose polygon
// contains p.
[[nodiscard]] std::int32_t facet_under(const ConvexBody& body, std::int32_t index,
                                       const Vec3& p) noexcept;

class ActiveFeature {
 public:
  // pose: null for body A, whose frame is frame A.
  ActiveFeature(const ConvexBody& body, const RelativePose* pose) noexcept
      : body_(body), pose_(pose) {}

  [[nodiscard]] const ConvexBody& body() const noexcept { return body_; }
  [[nodiscard]] FeatureKind feature() const noexcept { return feature_; }
  [[nodiscard]] std::int32_t index() const noexcept { return index_; }
  [[nodiscard]] const Vec3& point_L() const noexcept { return point_L_; }
  [[nodiscard]] const Vec3& point_A() const noexcept { return point_A_; }

  [[nodiscard]] const Facet& facet() const noexcept { return body_.facets[index_]; }
  [[nodiscard]] const Edge& edge() const noexcept { return body_.edges[index_]; }
  [[nodiscard]] const Vertex& vertex() const noexcept { return body_.vertices[index_]; }

  [[nodiscard]] Vec3 direction_to_a(const Vec3& v) const noexcept {
    return pose_ ? Vec3(pose_->rotation * v) : v;
  }
  [[nodiscard]] const RelativePose* pose() const noexcept { return pose_; }
  [[nodiscard]] Vec3 direction_A_to_L(const Vec3& v) const noexcept {
    return pose_ ? Vec3(pose_->rotation.transpose() * v) : v;
  }
  [[nodiscard]] Vec3 point_to_a(const Vec3& p) const noexcept {
    return pose_ ? Vec3(pose_->rotation * p + pose_->translation) : p;
  }

  void place(FeatureKind feature, std::int32_t index, const Vec3& local) noexcept {
    assert(feature == FeatureKind::kInside ? index == kNone
                                           : exists(body_, {feature, false, index}));
    feature_ = feature;
    index_ = index;
    point_L_ = local;
    point_A_ = point_to_a(local);
  }
  void place_at_vertex(std::int32_t index) noexcept {
    place(FeatureKind::kVertex, index, body_.vertices[index].position);
  }
  // On an edge, as near to `local` as its ends allow.
  void place_on_edge(std::int32_t index, const Vec3& local) noexcept {
    const Edge& e = body_.edges[index];
    const double s = std::clamp((local - e.point).dot(e.direction), e.begin, e.end);
    place(FeatureKind::kEdge, index, e.point + s * e.direction);
  }
  // Places the point on the plane of a facet: a long move along a rounded direction leaves the
  // plane.
  void place_on_facet(std::int32_t index, const Vec3& local) noexcept {
    const Facet& f = body_.facets[index];
    place(FeatureKind::kFacet, index, local - (f.normal.dot(local) - f.offset) * f.normal);
  }
  void place_inside(const Vec3& local) noexcept { place(FeatureKind::kInside, kNone, local); }

  // The start of a query without a hint: the support point towards `other` (frame A), or the inside
  // of a body without vertices.
  void place_cold(const Vec3& other) noexcept;
  // Starts where the last query ended, projected onto the feature. False if the hint is unusable.
  [[nodiscard]] bool place_tracked(const TrackingState::Side& hint) noexcept;
  // Tries place_tracked(), then place_cold(). `between_origins`: the length of the translation from
  // one frame to the other, m.
  void place_near(const TrackingState::Side& hint, const ActiveFeature& other,
                  double between_origins) noexcept;
  [[nodiscard]] TrackingState::Side tracked() const noexcept {
    return {feature_, false, index_, point_L_};
  }

 private:
  const ConvexBody& body_;
  const RelativePose* pose_;
  FeatureKind feature_ = FeatureKind::kInside;
  std::int32_t index_ = kNone;
  Vec3 point_L_ = Vec3::Zero(), point_A_ = Vec3::Zero();
};

}  // namespace clearance
