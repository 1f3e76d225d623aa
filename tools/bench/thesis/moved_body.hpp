// A polyhedron whose tables are moved to a pose at every query, as the base algorithm of Table 4.2
// needs them. All tables that the iteration reads are moved. (The thesis's iteration, without
// adjacency, read only the half-spaces.)
#pragma once

#include "core/convex_body.hpp"
#include "core/pose.hpp"

namespace clearance::bench {

class MovedBody {
 public:
  explicit MovedBody(const ConvexBody& own) : own_(own), moved_(own) {}

  [[nodiscard]] const ConvexBody& at_pose() const { return moved_; }

  void move(const Pose& world_from_body) {
    rotation_ = world_from_body.orientation.toRotationMatrix();
    translation_ = world_from_body.position;
    for (std::size_t i = 0; i < own_.facets.size(); ++i) {
      moved_.facets[i].normal = rotation_ * own_.facets[i].normal;
      moved_.facets[i].offset = own_.facets[i].offset + moved_.facets[i].normal.dot(translation_);
    }
    for (std::size_t i = 0; i < own_.edges.size(); ++i) {
      moved_.edges[i].point = point(own_.edges[i].point);
      moved_.edges[i].direction = rotation_ * own_.edges[i].direction;
      moved_.edges[i].inward = own_.edges[i].inward * rotation_.transpose();
    }
    for (std::size_t i = 0; i < own_.vertices.size(); ++i) {
      moved_.vertices[i].position = point(own_.vertices[i].position);
    }
    for (const Vertex& v : own_.vertices) {
      for (std::int32_t i = 0; i < v.edges; ++i) {
        moved_.set_outgoing(v, i, rotation_ * own_.outgoing_of(v, i));
      }
    }
    for (const Facet& f : own_.facets) {
      for (std::int32_t i = 0; i < f.limits; ++i) move_limit(f, i);
    }
    moved_.interior = point(own_.interior);
  }
  [[nodiscard]] Vec3 point(const Vec3& of_body) const { return rotation_ * of_body + translation_; }
  [[nodiscard]] Vec3 point_of_body(const Vec3& p) const {
    return rotation_.transpose() * (p - translation_);
  }

 private:
  void move_limit(const Facet& facet, std::int32_t i) {
    const FacetLimit own = own_.limit_of(facet, i);
    const Vec3 inward = rotation_ * own.inward;
    moved_.set_limit(facet, i, {inward, own.offset + inward.dot(translation_)});
  }

  const ConvexBody& own_;
  ConvexBody moved_;
  Mat3 rotation_;
  Vec3 translation_;
};

}  // namespace clearance::bench
