#include "monitor/bodies/bounding_sphere.hpp"

#include <algorithm>

#include "monitor/bodies/directed_rounding.hpp"

namespace clearance {
namespace {

// A part's sphere in its object's frame.
Sphere in_object(const PosedPart& part) noexcept {
  const Vec3& centre = part.sphere_in_part.centre;
  const double error = kPlacingError * (centre.norm() + part.object_from_part.position.norm());
  return {.centre = transform(part.object_from_part, centre),
          .radius = rounded_up(part.sphere_in_part.radius + error)};
}

BoundingSphere around(const std::vector<Sphere>& spheres, double bounding_radius) {
  Vec3 low = Vec3::Constant(kInfinity), high = Vec3::Constant(-kInfinity);
  for (const Sphere& sphere : spheres) {
    const double radius = std::isfinite(sphere.radius) ? sphere.radius : 0.0;
    low = low.cwiseMin(sphere.centre - Vec3::Constant(radius));
    high = high.cwiseMax(sphere.centre + Vec3::Constant(radius));
  }
  BoundingSphere all{.in_object = {.centre = 0.5 * (low + high), .radius = 0.0},
                     .bounding_radius = bounding_radius};
  if (spheres.size() == 1) all.in_object.centre = spheres.front().centre;
  for (const Sphere& sphere : spheres) {
    const double offset = rounded_up((sphere.centre - all.in_object.centre).norm());
    all.in_object.radius = std::max(all.in_object.radius, rounded_up(offset + sphere.radius));
  }
  all.bounding_radius = std::max(bounding_radius, rounded_up(all.in_object.centre.norm()));
  return all;
}

}  // namespace

std::vector<BoundingSphere> bounding_spheres(std::size_t objects,
                                             const std::vector<PosedPart>& parts) {
  std::vector<std::vector<Sphere>> spheres(objects);
  std::vector<double> radii(objects, 0.0);
  for (const PosedPart& part : parts) {
    spheres[part.object].push_back(in_object(part));
    radii[part.object] = std::max(radii[part.object], part.bounding_radius);
  }
  std::vector<BoundingSphere> all(objects);
  for (std::size_t i = 0; i < objects; ++i) {
    if (spheres[i].empty()) {
      all[i].in_object.radius = 0.0;
    } else {
      all[i] = around(spheres[i], radii[i]);
    }
  }
  return all;
}

Sphere placed(const BoundingSphere& sphere, const Pose& world_from_object) noexcept {
  const Vec3& centre = sphere.in_object.centre;
  const double error = kPlacingError * (centre.norm() + world_from_object.position.norm());
  return {.centre = transform(world_from_object, centre),
          .radius = rounded_up(sphere.in_object.radius + error)};
}

double least_between(const Sphere& a, const Sphere& b) noexcept {
  const double centres = (a.centre - b.centre).norm();
  return rounded_down(rounded_down(centres) - rounded_up(a.radius + b.radius));
}

double most_between(const Sphere& a, const Sphere& b) noexcept {
  const double centres = (a.centre - b.centre).norm();
  return rounded_up(rounded_up(centres) + rounded_up(a.radius + b.radius));
}

}  // namespace clearance
