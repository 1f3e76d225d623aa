// A polyhedron as the hull of its vertices, which are its smooth parts, with the same functions as
// the curved bodies (core/model/curved_body.hpp). Its support Hessian is 0.
//
// Each ray of an unbounded polyhedron counts as an edge from every vertex (ConvexBody::anchors),
// all of one length. All points that can be closest are in the hull of the vertices and of these
// edges' far ends.
#pragma once

#include "core/model/smooth_part.hpp"
#include "core/model/support_function.hpp"

namespace clearance {

class Polyhedron : public BodyDefaults {
 public:
  // ray_length: m; only for unbounded polyhedra.
  Polyhedron(const ConvexBody& body, double ray_length) noexcept
      : body_(body), ray_length_(ray_length) {}

  // ---- support ----
  // One part for each of the body's `anchors`, followed by as many again for each ray.
  [[nodiscard]] std::int32_t parts() const noexcept {
    return anchors() * (static_cast<std::int32_t>(body_.rays.size()) + 1);
  }
  [[nodiscard]] std::int32_t support_part(const Vec3& m) const noexcept {
    double steepest = 0.0;
    std::int32_t ray = 0;
    for (std::size_t i = 0; i < body_.rays.size(); ++i) {
      const double derivative = m.dot(body_.rays[i].direction.normalized());
      if (!(derivative > steepest)) continue;
      steepest = derivative;
      ray = static_cast<std::int32_t>(i) + 1;
    }
    return support(body_, m).anchor + ray * anchors();
  }
  [[nodiscard]] Vec3 support_point(std::int32_t part, const Vec3&) const noexcept {
    if (part < anchors()) return body_.anchors[static_cast<std::size_t>(part)];
    const auto ray = static_cast<std::size_t>(part / anchors() - 1);
    return body_.anchors[static_cast<std::size_t>(part % anchors())] +
           ray_length_ * body_.rays[ray].direction.normalized();
  }
  [[nodiscard]] PlaneMatrix support_hessian(std::int32_t, const Vec3&,
                                            const Tangents&) const noexcept {
    return {};
  }
  // Among all vertices of the support set along m, the support point along `towards`.
  [[nodiscard]] PointOfPart support_set_point(const Vec3& m, const Vec3& towards,
                                              double tolerance) const noexcept {
    const double top = m.dot(support_point(support_part(m), m));
    double greatest = -kInfinity;
    PointOfPart found;
    for (std::int32_t i = 0; i < parts(); ++i) {
      const Vec3 vertex = support_point(i, m);
      if (m.dot(vertex) < top - tolerance || !(towards.dot(vertex) > greatest)) continue;
      greatest = towards.dot(vertex);
      found = {vertex, i};
    }
    return found;
  }
  // The points are means of vertices with weights of sum 1.
  [[nodiscard]] Vec3 pulled_inside(const Vec3& point) const noexcept { return point; }

  [[nodiscard]] Ball inscribed_ball() const noexcept {
    return {body_.interior, body_.inner_radius};
  }

 private:
  [[nodiscard]] std::int32_t anchors() const noexcept {
    return static_cast<std::int32_t>(body_.anchors.size());
  }

  const ConvexBody& body_;
  double ray_length_;
};

}  // namespace clearance
