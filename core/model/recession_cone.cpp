#include "core/model/recession_cone.hpp"

#include <algorithm>

#include "core/convex_polyhedron.hpp"
#include "core/model/lean.hpp"

namespace clearance {
namespace {

void mark_lines(ConvexPolyhedron& body) {
  if (!body.vertices.empty()) return;
  for (Ray& ray : body.rays) {
    ray.is_line = std::any_of(body.rays.begin(), body.rays.end(), [&](const Ray& other) {
      return other.exactly.is_opposite_to(ray.exactly);
    });
  }
}

void sort_rays(const ConvexPolyhedron& body, Spread& out) {
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
double least_part(const Spread& of, const Vec3& against_normals) {
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

// Rays that lean by more than this (the sine) show it themselves.
constexpr double kPointsAway = 0x1p-20;

// Unit, or zero: how f leans away from the line of e.
Vec3 lean_of(const Ray& f, const Ray& e) {
  return narrow(apart(long_vec(e.exactly), long_vec(f.exactly)).way).stableNormalized();
}

void take_for_line(const ConvexPolyhedron& body, const Ray& line, Spread& out) {
  out.lines[out.line_count++] = line.direction.normalized();
  for (const Ray& ray : body.rays) {
    const Vec3 lean = lean_of(ray, line);
    if (!lean.isZero(0.0)) out.rays.push_back(lean);
  }
}

void add_leans(const ConvexPolyhedron& body, Opening& out) {
  for (const Ray& ray : body.rays) {
    const Vec3 direction = ray.direction.normalized();
    for (const Ray* other = body.rays.data(); other != &ray; ++other) {
      if (!((direction + other->direction.normalized()).norm() < kPointsAway)) continue;
      const Vec3 lean = lean_of(*other, ray);
      if (lean.isZero(0.0)) continue;
      out.leans.push_back(lean);
      if (out.line_count == 0 && out.relaxed.line_count == 0) take_for_line(body, ray, out.relaxed);
    }
  }
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
  mark_lines(body);
  sort_rays(body, body.opening);
  add_leans(body, body.opening);
  Vec3 against_normals = Vec3::Zero();
  for (const Facet& facet : body.facets) against_normals -= facet.normal;
  body.opening.least = least_part(body.opening, against_normals);
  if (body.opening.relaxed.line_count > 0) {
    body.opening.relaxed.least = least_part(body.opening.relaxed, against_normals);
  }
  body.opening.inwards = inwards(body, against_normals);
}

}  // namespace clearance
