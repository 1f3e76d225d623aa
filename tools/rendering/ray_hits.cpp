#include "tools/rendering/ray_hits.hpp"

#include <algorithm>
#include <cmath>

#include "core/convex_body.hpp"

namespace clearance::rendering {

double hit_sphere(const Vec3& centre, double radius, const Vec3& direction) noexcept {
  const double squared = direction.squaredNorm(), along = direction.dot(centre);
  if (centre.squaredNorm() <= radius * radius) return 0.0;
  // The centre's distance from the ray's line, without the cancellation of the usual discriminant.
  const Vec3 across = centre - (along / squared) * direction;
  const double half = radius * radius - across.squaredNorm();
  if (half < 0.0 || along < 0.0) return kInfinity;
  return (along - std::sqrt(squared * half)) / squared;
}

double hit_capsule(const Vec3& start, const Vec3& end, double radius,
                   const Vec3& direction) noexcept {
  const Vec3 axis = end - start;
  const double axis_squared = axis.squaredNorm();
  const double nearest = std::clamp(-start.dot(axis) / axis_squared, 0.0, 1.0);
  if ((start + nearest * axis).squaredNorm() <= radius * radius) return 0.0;
  const auto least_of_caps = [&] {
    return std::min(hit_sphere(start, radius, direction), hit_sphere(end, radius, direction));
  };
  // Everything across the axis: there the infinite cylinder is a circle around `centre`.
  const Vec3 along = direction - (direction.dot(axis) / axis_squared) * axis;
  const Vec3 centre = start - (start.dot(axis) / axis_squared) * axis;
  const double squared = along.squaredNorm();
  if (squared <= 1e-24 * direction.squaredNorm()) return least_of_caps();
  const double towards = along.dot(centre) / squared;
  const double half = radius * radius - (centre - towards * along).squaredNorm();
  if (half < 0.0) return kInfinity;
  const double t = towards - std::sqrt(half / squared);
  const double place = (t * direction - start).dot(axis) / axis_squared;
  if (place >= 0.0 && place <= 1.0) return t >= 0.0 ? t : kInfinity;
  return hit_sphere(place < 0.0 ? start : end, radius, direction);
}

// Between the planes of the discs, the body is where x^2 + y^2 <= r(z)^2 with r linear in z and not
// negative: a convex set, which the ray enters at the first root after it has passed a plane.
double hit_truncated_cone(const CurvedShape& cone, const Vec3& origin,
                          const Vec3& direction) noexcept {
  const Disc &lower = cone.discs[0], &upper = cone.discs[1];
  double begin = 0.0, end = kInfinity;
  const auto clip = [&](double from, double speed) {  // from + speed t >= 0
    if (speed > 0.0) {
      begin = std::max(begin, -from / speed);
    } else if (speed < 0.0) {
      end = std::min(end, -from / speed);
    } else if (from < 0.0) {
      end = -1.0;
    }
  };
  clip(origin.z() - lower.height, direction.z());
  clip(upper.height - origin.z(), -direction.z());
  if (begin > end) return kInfinity;
  const double slope = (upper.radius - lower.radius) / (upper.height - lower.height);
  const double radius = lower.radius + slope * (origin.z() - lower.height);
  const double growth = slope * direction.z();
  const Vec2 from = origin.head<2>(), along = direction.head<2>();
  // f(t) = a t^2 + 2 b t + c is positive outside.
  const double a = along.squaredNorm() - growth * growth;
  const double b = along.dot(from) - growth * radius;
  const double c = from.squaredNorm() - radius * radius;
  if ((a * begin + 2.0 * b) * begin + c <= 0.0) return begin;
  if (a == 0.0) {
    const double t = b < 0.0 ? -c / (2.0 * b) : kInfinity;
    return t >= begin && t <= end ? t : kInfinity;
  }
  const double discriminant = b * b - a * c;
  if (discriminant < 0.0) return kInfinity;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b));
  const double one = q / a, other = q == 0.0 ? one : c / q;
  for (const double t : {std::min(one, other), std::max(one, other)}) {
    if (t >= begin) return t <= end ? t : kInfinity;
  }
  return kInfinity;
}

double hit_ellipsoid(const CurvedShape& ellipsoid, const Vec3& origin,
                     const Vec3& direction) noexcept {
  const Vec3& axes = ellipsoid.semi_axes;
  return hit_sphere(-origin.cwiseQuotient(axes), 1.0, direction.cwiseQuotient(axes));
}

}  // namespace clearance::rendering
