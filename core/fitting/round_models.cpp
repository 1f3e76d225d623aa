// Sphere, capsule and cylinder.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/fitting/enclosing_circle.hpp"
#include "core/fitting/fitted.hpp"

namespace clearance {
namespace {

// Of the sphere's centre; the radius comes within 1 / kCentreSteps of the least (M. Badoiu and K.
// L. Clarkson, "Smaller core-sets for balls", 2003).
constexpr int kCentreSteps = 2000;

// Along an axis: the circle around the body seen along it, and from where to where it reaches.
struct Along {
  Eigen::Quaterniond turn;
  std::vector<Vec3> points;  // in the frame whose z is the axis
  Circle circle;
  double low = kInfinity, high = -kInfinity;  // m, along the axis
};

Along seen_along(const ConvexBody& body, const Vec3& axis) {
  Along seen;
  seen.turn = turn_to(axis);
  seen.points = vertices_in(body, seen.turn);
  std::vector<Vec2> shadow;
  shadow.reserve(seen.points.size());
  for (const Vec3& p : seen.points) shadow.emplace_back(p.x(), p.y());
  seen.circle = enclosing_circle(convex_polygon(std::move(shadow)));
  // What the circle's own rounding leaves out.
  for (const Vec3& p : seen.points) {
    const double off = std::hypot(p.x() - seen.circle.centre.x(), p.y() - seen.circle.centre.y());
    seen.circle.radius = std::max(seen.circle.radius, off);
    seen.low = std::min(seen.low, p.z());
    seen.high = std::max(seen.high, p.z());
  }
  return seen;
}

struct Ends {
  double low, high;
};

// The shortest segment on the circle's axis, so that the capsule of this radius holds all points.
// One point where a sphere does.
Ends capsule_ends(const Along& seen, double radius) {
  Ends ends{kInfinity, -kInfinity};
  for (const Vec3& p : seen.points) {
    const double off = std::hypot(p.x() - seen.circle.centre.x(), p.y() - seen.circle.centre.y());
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
                point(Vec3::Zero(), radius + kFittingSlack * (radius + size_of(body))), at, body);
}

EnclosingModel enclosing_capsule(const ConvexBody& body) {
  const Vec3 axis = best_direction(starts_of(body), [&](const Vec3& tried) {
    const Along seen = seen_along(body, tried);
    const Ends ends = capsule_ends(seen, seen.circle.radius);
    return capsule_volume(seen.circle.radius, ends.high - ends.low);
  });
  const Along seen = seen_along(body, axis);
  const Ends ends = capsule_ends(seen, seen.circle.radius);
  const Mat3 turn = rotation_matrix(seen.turn);
  const Vec2& c = seen.circle.centre;
  const double half = 0.5 * (ends.high - ends.low), slack = kFittingSlack * size_of(body);
  Pose at;
  at.position = turn * Vec3(c.x(), c.y(), 0.5 * (ends.low + ends.high));
  at.orientation = seen.turn;
  // The radius that the segment, rounded as it is, needs.
  double radius = seen.circle.radius;
  for (const Vec3& p : body.anchors) {
    const Vec3 own = turn.transpose() * (p - at.position);
    const double past = std::max(0.0, std::abs(own.z()) - half);
    radius = std::max(radius, Vec3(own.x(), own.y(), past).norm());
  }
  radius += 4.0 * slack;
  if (half <= slack) {
    return fitted(ModelKind::kCapsule, point(Vec3::Zero(), radius + half), at, body);
  }
  return fitted(ModelKind::kCapsule, segment({0, 0, -half}, {0, 0, half}, radius), at, body);
}

EnclosingModel enclosing_cylinder(const ConvexBody& body) {
  const Vec3 axis = best_direction(starts_of(body), [&](const Vec3& tried) {
    const Along seen = seen_along(body, tried);
    return seen.circle.radius * seen.circle.radius * (seen.high - seen.low);
  });
  const Along seen = seen_along(body, axis);
  const Vec2& c = seen.circle.centre;
  const double slack = 4.0 * kFittingSlack * size_of(body);
  Pose at;
  at.position = rotation_matrix(seen.turn) * Vec3(c.x(), c.y(), 0.5 * (seen.low + seen.high));
  at.orientation = seen.turn;
  const double half = 0.5 * (seen.high - seen.low);
  return fitted(ModelKind::kCylinder, cylinder(seen.circle.radius + slack, half + slack), at, body);
}

}  // namespace clearance
