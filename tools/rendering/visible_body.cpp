#include "tools/rendering/visible_body.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/distance.hpp"
#include "core/shapes.hpp"
#include "tools/rendering/ray_hits.hpp"

namespace clearance::rendering {
namespace {

constexpr double kOnPlane = 1e-12;  // m: a camera this near to a plane is taken to be behind it

// The largest and least tangents of a circle's directions around the camera, in the plane of one
// axis and the viewing direction.
std::array<double, 2> tangents(double across, double forward, double radius) noexcept {
  constexpr double kRight = 1.5707963267948966;
  const double away = std::hypot(across, forward);
  if (away <= radius) return {-kInfinity, kInfinity};
  const double middle = std::atan2(across, forward), half = std::asin(radius / away);
  return {middle - half <= -kRight ? -kInfinity : std::tan(middle - half),
          middle + half >= kRight ? kInfinity : std::tan(middle + half)};
}

const ConvexBody& point_at_origin() {
  static const ConvexBody body = std::get<ConvexBody>(point(Vec3::Zero(), 0.0));
  return body;
}

}  // namespace

VisibleBody::Kind VisibleBody::kind_of(const ConvexBody& shape) noexcept {
  if (shape.is_curved()) {
    if (shape.radius > 0.0) return Kind::kAnyShape;
    return shape.curved.kind == CurvedShape::Kind::kEllipsoid ? Kind::kEllipsoid
                                                              : Kind::kTruncatedCone;
  }
  if (shape.is_thin()) {
    if (shape.radius == 0.0) return Kind::kNone;
    return shape.vertices.size() == 1 ? Kind::kSphere : Kind::kCapsule;
  }
  if (shape.radius == 0.0) return Kind::kPolyhedron;
  return shape.bounded() ? Kind::kRoundedPolyhedron : Kind::kAnyShape;
}

VisibleBody::VisibleBody(const ConvexBody& shape, const Pose& camera_from_body)
    : shape_(shape),
      kind_(kind_of(shape)),
      body_from_camera_(rotation_matrix(camera_from_body.orientation).transpose()),
      camera_in_body_(-(body_from_camera_ * camera_from_body.position)) {
  if (kind_ == Kind::kPolyhedron || kind_ == Kind::kRoundedPolyhedron) place_planes();
  if (kind_ == Kind::kRoundedPolyhedron) {
    for (const Edge& edge : shape.edges) {
      const Vec3 end = edge.point + edge.end * edge.direction;
      edges_.push_back({body_from_camera_.transpose() * (edge.point - camera_in_body_),
                        body_from_camera_.transpose() * (end - camera_in_body_)});
    }
  }
  if (shape.bounded()) place_balls();
}

// The planes of a rounded body are those of its facets, moved outward by the radius.
void VisibleBody::place_planes() {
  for (const Facet& facet : shape_.facets) {
    const double ahead = facet.offset + shape_.radius - facet.normal.dot(camera_in_body_);
    const Vec3 normal = body_from_camera_.transpose() * facet.normal;
    if (ahead < -kOnPlane) {
      front_.push_back(normal / ahead);
    } else {
      back_.push_back(normal / std::max(ahead, kOnPlane));
    }
  }
}

void VisibleBody::place_balls() {
  const auto add = [&](const Vec3& centre, double radius) {
    balls_.push_back({body_from_camera_.transpose() * (centre - camera_in_body_), radius});
  };
  if (shape_.curved.kind == CurvedShape::Kind::kTruncatedCone) {
    for (const Disc& disc : shape_.curved.discs)
      add({0.0, 0.0, disc.height}, disc.radius + shape_.radius);
  } else if (shape_.is_curved()) {
    add(Vec3::Zero(), shape_.bounding_radius + shape_.radius);
  } else {
    for (const Vertex& vertex : shape_.vertices) add(vertex.position, shape_.radius);
  }
}

ViewRange VisibleBody::range() const noexcept {
  constexpr ViewRange kAll{-kInfinity, kInfinity, -kInfinity, kInfinity};
  constexpr ViewRange kNothing{kInfinity, -kInfinity, kInfinity, -kInfinity};
  if (kind_ == Kind::kNone) return kNothing;
  if (balls_.empty()) return kAll;
  ViewRange range = kNothing;
  bool any_behind = false, all_behind = true;
  for (const Ball& ball : balls_) {
    any_behind |= ball.centre.z() - ball.radius <= 0.0;
    all_behind &= ball.centre.z() + ball.radius <= 0.0;
    const auto x = tangents(ball.centre.x(), ball.centre.z(), ball.radius);
    const auto y = tangents(ball.centre.y(), ball.centre.z(), ball.radius);
    range = {std::min(range.left, x[0]), std::max(range.right, x[1]), std::min(range.top, y[0]),
             std::max(range.bottom, y[1])};
  }
  if (all_behind) return kNothing;
  return any_behind ? kAll : range;
}

double VisibleBody::hit_planes(const Vec3& direction) const noexcept {
  double most = kInfinity, least = 0.0;  // of 1 / t
  for (const Vec3& plane : front_) most = std::min(most, plane.dot(direction));
  for (const Vec3& plane : back_) least = std::max(least, plane.dot(direction));
  if (most < least || most <= 0.0) return kInfinity;
  return 1.0 / most;  // 0 inside
}

bool VisibleBody::is_over_facet(const Facet& facet, const Vec3& point_in_body) const noexcept {
  for (std::int32_t i = facet.first_side; i < facet.first_side + facet.sides; ++i) {
    const EdgeUse& use = shape_.facet_edges[static_cast<std::size_t>(i)];
    const Edge& edge = shape_.edges[static_cast<std::size_t>(use.edge)];
    if ((point_in_body - edge.point).dot(edge.inward.row(use.side)) < 0.0) return false;
  }
  return true;
}

// The body is the union of the prisms over its facets, of the capsules around its edges, and of the
// polyhedron within. If the ray enters the moved planes over a facet, it enters there.
double VisibleBody::hit_rounded(const Vec3& direction) const noexcept {
  const double earliest = hit_planes(direction);
  if (earliest == kInfinity) return kInfinity;
  double first = kInfinity;
  for (const auto& [start, end] : edges_)
    first = std::min(first, hit_capsule(start, end, shape_.radius, direction));
  const Vec3 along = body_from_camera_ * direction;
  const Vec3 from = camera_in_body_;
  bool is_inside = true;  // the camera, in the polyhedron without the radius
  for (const Facet& facet : shape_.facets) {
    const double slope = facet.normal.dot(along);
    const double ahead = facet.offset + shape_.radius - facet.normal.dot(from);
    is_inside &= ahead >= shape_.radius;
    if (ahead >= 0.0 && ahead <= shape_.radius && is_over_facet(facet, from)) return 0.0;
    if (slope >= 0.0 || ahead > 0.0) continue;
    const double t = ahead / slope;
    if (t < first && is_over_facet(facet, from + t * along)) first = t;
  }
  return is_inside ? 0.0 : first;
}

// The distance is a convex function of t, so that Newton's steps from the left never pass its root.
double VisibleBody::hit_by_distance(const Vec3& direction) const noexcept {
  constexpr int kMostSteps = 200;
  constexpr double kNear = 1e-11;  // m
  const Vec3 along = body_from_camera_ * direction;
  TrackingState state;
  RelativePose at;
  double t = 0.0;
  for (int i = 0; i < kMostSteps; ++i) {
    at.translation = camera_in_body_ + t * along;
    const DistanceResult found = distance(shape_, point_at_origin(), at, state, {.depth = false});
    if (found.status == DistanceStatus::kBadPose) return kInfinity;
    if (found.status == DistanceStatus::kDepthNotAsked || found.distance <= kNear) return t;
    const double slope = found.normal.dot(along);
    if (!(slope < 0.0)) return kInfinity;
    t -= found.distance / slope;
    if (!(t < 1e9)) return kInfinity;
  }
  return kInfinity;
}

double VisibleBody::first_hit(const Vec3& direction) const noexcept {
  const auto centre = [&](std::size_t i) -> const Vec3& { return balls_[i].centre; };
  switch (kind_) {
    case Kind::kNone:
      return kInfinity;
    case Kind::kSphere:
      return hit_sphere(centre(0), shape_.radius, direction);
    case Kind::kCapsule:
      return hit_capsule(centre(0), centre(1), shape_.radius, direction);
    case Kind::kPolyhedron:
      return hit_planes(direction);
    case Kind::kRoundedPolyhedron:
      return hit_rounded(direction);
    case Kind::kTruncatedCone:
      return hit_truncated_cone(shape_.curved, camera_in_body_, body_from_camera_ * direction);
    case Kind::kEllipsoid:
      return hit_ellipsoid(shape_.curved, camera_in_body_, body_from_camera_ * direction);
    case Kind::kAnyShape:
      return hit_by_distance(direction);
  }
  return kInfinity;
}

}  // namespace clearance::rendering
