// Sphere, capsule and cylinder.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/scene/fitting/enclosing_circle.hpp"
#include "tools/scene/fitting/fitted.hpp"

namespace clearance {
namespace {

// Steps of the sphere's centre. The radius comes within 1 / kCentreSteps of the least (M. Badoiu
// and K. L. Clarkson, "Smaller core-sets for balls", 2003).
constexpr int kCentreSteps = 2000;

// The circle around the body's projection along an axis, and its extent on that axis.
struct Projection {
  Eigen::Quaterniond rotation;
  std::vector<Vec3> points;  // in the frame whose z is the axis
  Circle circle;
  double low = kInfinity, high = -kInfinity;  // m, along the axis
};

Projection projection_along(const ConvexBody& body, const Vec3& axis) {
  Projection projected;
  projected.rotation = rotation_to(axis);
  projected.points = vertices_in(body, projected.rotation);
  std::vector<Vec2> shadow;
  shadow.reserve(projected.points.size());
  for (const Vec3& p : projected.points) shadow.emplace_back(p.x(), p.y());
  projected.circle = enclosing_circle(convex_polygon(std::move(shadow)));
  // The circle's rounding may leave points outside.
  for (const Vec3& p : projected.points) {
    const double off =
        std::hypot(p.x() - projected.circle.centre.x(), p.y() - projected.circle.centre.y());
    projected.circle.radius = std::max(projected.circle.radius, off);
    projected.low = std::min(projected.low, p.z());
    projected.high = std::max(projected.high, p.z());
  }
  return projected;
}

struct Ends {
  double low, high;
};

// The shortest segment on the circle's axis for which the capsule of this radius holds all points.
// It is one point where a sphere holds them.
Ends capsule_ends(const Projection& projected, double radius) {
  Ends ends{kInfinity, -kInfinity};
  for (const Vec3& p : projected.points) {
    const double off =
        std::hypot(p.x() - projected.circle.centre.x(), p.y() - projected.circle.centre.y());
    const double cap = std::sqrt(std::max(0.0, radius * radius - off * off));
    ends.low = std::min(ends.low, p.z() + cap);
    ends.high = std::max(ends.high, p.z() - cap);
  }
  if (ends.low > ends.high) ends.low = ends.high = 0.5 * (ends.low + ends.high);
  return ends;
}

double capsule_volume(double radius, double length) {
  return std::numbers::pi * radius * radius * (length + 4.0 / 3.0 * radius);
}

std::vector<Vec3> starts_of(const ConvexBody& body) {
  const Mat3 axes = principal_axes(body);
  return {Vec3(axes.col(2)), Vec3(axes.col(1)), Vec3(axes.col(0))};
}

}  // namespace

EnclosingModel enclosing_sphere(const ConvexBody& body) {
  Vec3 centre = body.anchors[0];
  for (int k = 1; k <= kCentreSteps; ++k) {
    const auto farthest = std::max_element(
        body.anchors.begin(), body.anchors.end(), [&](const Vec3& p, const Vec3& q) {
          return (p - centre).squaredNorm() < (q - centre).squaredNorm();
        });
    centre += (*farthest - centre) / (k + 1);
  }
  double radius = 0.0;
  for (const Vec3& p : body.anchors) radius = std::max(radius, (p - centre).norm());
  Pose at;
  at.position = centre;
  return fitted(ModelKind::kSphere,
                point(Vec3::Zero(), radius + kFittingMargin * (radius + size_of(body))), at, body);
}

EnclosingModel enclosing_capsule(const ConvexBody& body) {
  const Vec3 axis = best_direction(starts_of(body), [&](const Vec3& tried) {
    const Projection projected = projection_along(body, tried);
    const Ends ends = capsule_ends(projected, projected.circle.radius);
    return capsule_volume(projected.circle.radius, ends.high - ends.low);
  });
  const Projection projected = projection_along(body, axis);
  const Ends ends = capsule_ends(projected, projected.circle.radius);
  const Mat3 rotation = rotation_matrix(projected.rotation);
  const Vec2& c = projected.circle.centre;
  const double half = 0.5 * (ends.high - ends.low), margin = kFittingMargin * size_of(body);
  Pose at;
  at.position = rotation * Vec3(c.x(), c.y(), 0.5 * (ends.low + ends.high));
  at.orientation = projected.rotation;
  // The radius for the segment after rounding.
  double radius = projected.circle.radius;
  for (const Vec3& p : body.anchors) {
    const Vec3 local = rotation.transpose() * (p - at.position);
    const double excess = std::max(0.0, std::abs(local.z()) - half);
    radius = std::max(radius, Vec3(local.x(), local.y(), excess).norm());
  }
  radius += 4.0 * margin;
  if (half <= margin) {
    return fitted(ModelKind::kCapsule, point(Vec3::Zero(), radius + half), at, body);
  }
  return fitted(ModelKind::kCapsule, segment({0, 0, -half}, {0, 0, half}, radius), at, body);
}

EnclosingModel enclosing_cylinder(const ConvexBody& body) {
  const Vec3 axis = best_direction(starts_of(body), [&](const Vec3& tried) {
    const Projection projected = projection_along(body, tried);
    return projected.circle.radius * projected.circle.radius * (projected.high - projected.low);
  });
  const Projection projected = projection_along(body, axis);
  const Vec2& c = projected.circle.centre;
  const double margin = 4.0 * kFittingMargin * size_of(body);
  Pose at;
  at.position = rotation_matrix(projected.rotation) *
                Vec3(c.x(), c.y(), 0.5 * (projected.low + projected.high));
  at.orientation = projected.rotation;
  const double half = 0.5 * (projected.high - projected.low);
  return fitted(ModelKind::kCylinder, cylinder(projected.circle.radius + margin, half + margin), at,
                body);
}

}  // namespace clearance
