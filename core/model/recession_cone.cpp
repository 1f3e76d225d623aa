#include "core/model/recession_cone.hpp"

#include <algorithm>

#include "core/convex_polyhedron.hpp"

namespace clearance {
namespace {

void sort_rays(const ConvexPolyhedron& body, Opening& out) {
  for (const Ray& ray : body.rays) {
    if (!ray.is_line) {
      out.rays.push_back(ray.exact ? Vec3(ray.direction.normalized()) : ray.direction);
    } else if (out.line_count < out.lines.size()) {
      const Vec3 rest = out.across_lines(ray.direction.normalized());
      if (rest.norm() > 0.5) out.lines[out.line_count++] = rest.normalized();
    }
  }
}

// Two directions are tried: against the sum of the facets' normals, as no ray leads out of a facet
// and only lines run along all of them, and the sum of the rays, along which one of many may have
// nothing but those of a slender cone have all.
double least_part(const Opening& of, const Vec3& against_normals) {
  Vec3 along = Vec3::Zero();
  for (const Vec3& ray : of.rays) along += ray;
  double most = -kInfinity;
  for (const Vec3& sum : {against_normals, along}) {
    const Vec3 way = of.across_lines(sum).stableNormalized();
    double least = kInfinity;
    for (const Vec3& ray : of.rays) least = std::min(least, way.dot(ray));
    most = std::max(most, least);
  }
  return most - kSlopeError;
}

// Against the sum of all normals, if it leads away from each by more than rounding.
Vec3 inwards(const ConvexPolyhedron& body, const Vec3& against_normals) {
  constexpr double kAway = 0x1p-20;
  const Vec3 way = against_normals.stableNormalized();
  const bool away = std::all_of(body.facets.begin(), body.facets.end(),
                                [&](const Facet& facet) { return facet.normal.dot(way) < -kAway; });
  return away ? way : Vec3(Vec3::Zero());
}

}  // namespace

void add_opening(ConvexPolyhedron& body) {
  body.opening = {};
  if (body.bounded()) return;
  sort_rays(body, body.opening);
  Vec3 against_normals = Vec3::Zero();
  for (const Facet& facet : body.facets) against_normals -= facet.normal;
  body.opening.least = least_part(body.opening, against_normals);
  body.opening.inwards = inwards(body, against_normals);
}

}  // namespace clearance
