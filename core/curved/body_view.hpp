// A body during one query, and the numbers of its smooth parts and planar faces.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/curved/polyhedron.hpp"
#include "core/model/curved_body.hpp"

namespace clearance {

// A smooth part of A and one of B.
struct PartPair {
  std::int32_t a = kNone, b = kNone;
  [[nodiscard]] bool operator==(const PartPair&) const noexcept = default;
};

// The pairs of parts that are equally near along the best direction. A hint and never a fact.
struct ActiveParts {
  std::array<PartPair, 3> pairs;
  std::size_t count = 0;
};

struct BodyView {
  const ConvexBody* body = nullptr;
  double bounding_radius = 0.0;  // no point of a part is farther from the frame's origin, m
  double ray_length = 0.0;       // of an unbounded polyhedron's rays, m: see Polyhedron
  // The direction from the axis to the rim point that stands for a whole cap (unit).
  Vec2 rim_azimuth{1.0, 0.0};
};

// f(body), the body being an Ellipsoid, a TruncatedCone or a Polyhedron.
template <class F>
decltype(auto) visit(const BodyView& view, F&& f) {
  if (!view.body->is_curved()) return f(Polyhedron(*view.body, view.ray_length));
  return visit(view.body->curved, f, view.rim_azimuth);
}

// `within`: no point that can be closest is farther from the frame's origin, m. A closest point of
// an unbounded polyhedron is a mean of `anchors` plus a sum of up to three rays. Each ray has a
// component of at least RecessionCone::least along one direction.
[[nodiscard]] inline BodyView view_of(const ConvexBody& body, double within) noexcept {
  BodyView view{&body, body.bounding_radius};
  if (body.bounded()) return view;
  constexpr double kNarrowest = 0x1p-20;
  const double least = std::clamp(body.recession_cone.least, kNarrowest, 1.0);
  view.ray_length = 4.0 * (within + body.bounding_radius) / least;
  view.bounding_radius += view.ray_length;
  return view;
}

// ---- numbers ----
[[nodiscard]] inline bool has_caps(const ConvexBody& body) noexcept {
  return body.is_curved() && visit(body.curved, [](const auto& shape) { return shape.kHasCaps; });
}
[[nodiscard]] inline std::int32_t parts_of(const ConvexBody& body) noexcept {
  return visit(BodyView{&body}, [](const auto& shape) { return shape.parts(); });
}
// The numbers of planar faces follow those of the parts. They are the facets of a bounded
// polyhedron, or the caps of a truncated cone, the lower one first. Along its normal, the whole
// face is the support set.
[[nodiscard]] inline std::int32_t first_planar_face(const ConvexBody& body) noexcept {
  return body.is_curved() ? 2 : static_cast<std::int32_t>(body.anchors.size());
}
[[nodiscard]] inline std::int32_t planar_faces_of(const ConvexBody& body) noexcept {
  if (body.is_curved()) return has_caps(body) ? 2 : 0;
  return body.bounded() ? static_cast<std::int32_t>(body.facets.size()) : 0;
}
[[nodiscard]] inline bool has_part_or_face(const ConvexBody& body, std::int32_t number) noexcept {
  const std::int32_t face = number - first_planar_face(body);
  return number >= 0 && (number < parts_of(body) || (face >= 0 && face < planar_faces_of(body)));
}

// ---- support, in the body's frame; m: unit ----
[[nodiscard]] inline std::int32_t support_part(const BodyView& view, const Vec3& m) noexcept {
  return visit(view, [&](const auto& body) { return body.support_part(m); });
}
[[nodiscard]] inline Vec3 support_point(const BodyView& view, std::int32_t part,
                                        const Vec3& m) noexcept {
  return visit(view, [&](const auto& body) { return body.support_point(part, m); });
}
[[nodiscard]] inline PlaneMatrix support_hessian(const BodyView& view, std::int32_t part,
                                                 const Vec3& m, const Tangents& tangents) noexcept {
  return visit(view, [&](const auto& body) { return body.support_hessian(part, m, tangents); });
}
// For a body with h(m) = c.m + |D m|, the greatest |D t| over unit tangents t, divided by |D m|.
[[nodiscard]] inline double relative_slope(const BodyView& view, const Vec3& m) noexcept {
  return visit(view, [&](const auto& body) { return body.relative_slope(m); });
}
// For a point near the surface of the body: a point near it that lies in the body up to rounding.
[[nodiscard]] inline Vec3 pulled_inside(const BodyView& view, const Vec3& point) noexcept {
  return visit(view, [&](const auto& body) { return Vec3(body.pulled_inside(point)); });
}

}  // namespace clearance
