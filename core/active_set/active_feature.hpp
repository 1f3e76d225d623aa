// One body during a query: its active feature, and its point x on it (§3.3: the active set of one
// object).
//
// The active set is kept as the face of the polyhedron that it defines: no facet active is the
// inside, one a facet, two an edge, three or more a vertex. All facets that meet in a vertex are
// active there at once, which is what takes the sting out of degenerate vertices (core/README.md).
// x lies in the feature, in the body's own frame, where the body does not move (§3.4.4); its image
// in the common frame, A's, is kept too.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/convex_body.hpp"
#include "core/distance_result.hpp"
#include "core/pose.hpp"

namespace clearance {

// What limits a facet's polygon, of its Facet::limits, beyond whose line p lies farthest, by more
// than `tolerance` (m); kNone: p lies within.
[[nodiscard]] std::int32_t crossed_limit(const ConvexBody& body, const Facet& facet, const Vec3& p,
                                         double tolerance = 0.0) noexcept;

// Facets may be parallel to within rounding, and which of their planes a point lies on is
// rounding's choice: from one of them to that whose polygon p is in.
[[nodiscard]] std::int32_t facet_under(const ConvexBody& body, std::int32_t index,
                                       const Vec3& p) noexcept;

class ActiveFeature {
 public:
  // pose: null for the body whose frame is the common one.
  ActiveFeature(const ConvexBody& body, const RelativePose* pose) noexcept
      : body_(body), pose_(pose) {}

  [[nodiscard]] const ConvexBody& body() const noexcept { return body_; }
  [[nodiscard]] FeatureKind feature() const noexcept { return feature_; }
  [[nodiscard]] std::int32_t index() const noexcept { return index_; }
  [[nodiscard]] const Vec3& own() const noexcept { return own_; }
  [[nodiscard]] const Vec3& common() const noexcept { return common_; }

  [[nodiscard]] const Facet& facet() const noexcept { return body_.facets[index_]; }
  [[nodiscard]] const Edge& edge() const noexcept { return body_.edges[index_]; }
  [[nodiscard]] const Vertex& vertex() const noexcept { return body_.vertices[index_]; }

  [[nodiscard]] Vec3 direction_to_common(const Vec3& v) const noexcept {
    return pose_ ? Vec3(pose_->rotation * v) : v;
  }
  [[nodiscard]] const RelativePose* pose() const noexcept { return pose_; }
  [[nodiscard]] Vec3 direction_to_own(const Vec3& v) const noexcept {
    return pose_ ? Vec3(pose_->rotation.transpose() * v) : v;
  }
  [[nodiscard]] Vec3 point_to_common(const Vec3& p) const noexcept {
    return pose_ ? Vec3(pose_->rotation * p + pose_->translation) : p;
  }

  void place(FeatureKind feature, std::int32_t index, const Vec3& own) noexcept {
    feature_ = feature;
    index_ = index;
    own_ = own;
    common_ = point_to_common(own);
  }
  void place_at_vertex(std::int32_t index) noexcept {
    place(FeatureKind::kVertex, index, body_.vertices[index].position);
  }
  // On an edge, as near to `own` as its ends allow.
  void place_on_edge(std::int32_t index, const Vec3& own) noexcept {
    const Edge& e = body_.edges[index];
    const double s = std::clamp((own - e.point).dot(e.direction), e.begin, e.end);
    place(FeatureKind::kEdge, index, e.point + s * e.direction);
  }
  // On a facet's plane: a long way along a rounded direction leaves it.
  void place_on_facet(std::int32_t index, const Vec3& own) noexcept {
    const Facet& f = body_.facets[index];
    place(FeatureKind::kFacet, index, own - (f.normal.dot(own) - f.offset) * f.normal);
  }
  void place_inside(const Vec3& own) noexcept { place(FeatureKind::kInside, kNone, own); }

  // Where a query starts that knows nothing: a vertex that is far out towards `other` (common
  // frame); inside, where the body has none.
  void place_cold(const Vec3& other) noexcept;
  // Where the last query ended, re-anchored on the feature. False if the hint is unusable.
  [[nodiscard]] bool place_tracked(const TrackingState::Side& hint) noexcept;
  // One or the other. apart: m, between the bodies' origins.
  void place_near(const TrackingState::Side& hint, const ActiveFeature& other,
                  double apart) noexcept;
  [[nodiscard]] TrackingState::Side tracked() const noexcept {
    return {feature_, false, index_, own_};
  }

 private:
  const ConvexBody& body_;
  const RelativePose* pose_;
  FeatureKind feature_ = FeatureKind::kInside;
  std::int32_t index_ = kNone;
  Vec3 own_ = Vec3::Zero(), common_ = Vec3::Zero();
};

}  // namespace clearance
