#include "config/decomposition/exact_parts.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "config/decomposition/surface_error.hpp"
#include "config/decomposition/triangle_tree.hpp"
#include "config/decomposition/walls.hpp"

namespace clearance {
namespace {

// A share of the tolerance: a shell is convex if its hull has no larger error.
constexpr double kConvex = 0.01;
// Relative to the size: the rounding of a facet's plane.
constexpr double kPlaneRounding = 1e-15;
constexpr double kSafe = 0.5;       // of the overlap of cells: the rest is for rounding
constexpr double kOpenShare = 0.3;  // of the tolerance: as in the search for parts

std::optional<ConvexBody> hull_of(const std::vector<Vec3>& points) {
  ShapeResult made = polyhedron_from_vertices(points);
  auto* body = std::get_if<ConvexBody>(&made);
  return body == nullptr ? std::nullopt : std::optional(std::move(*body));
}

bool holds(const ConvexBody& body, const Vec3& point) {
  const double slack = kPlaneRounding * body.bounding_radius;
  return std::ranges::all_of(body.facets, [&](const Facet& facet) {
    return facet.normal.dot(point) <= facet.offset + slack;
  });
}

bool holds(const ConvexBody& body, std::span<const Vec3> points) {
  return std::ranges::all_of(points, [&](const Vec3& point) { return holds(body, point); });
}

bool is_convex(const TriangleMesh& shell, double tolerance) {
  std::optional<ConvexBody> hull = hull_of(shell.vertices);
  return hull && surface_error({&*hull, 1}, TriangleTree(shell), 0.1 * kConvex * tolerance,
                               kConvex * tolerance) <= kConvex * tolerance;
}

// Removes bodies that lie in another one.
void remove_inner(std::vector<ConvexBody>& bodies) {
  for (std::size_t i = bodies.size(); i-- > 0;) {
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (k == i || !holds(bodies[k], bodies[i].anchors)) continue;
      bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    }
  }
}

bool hold_each_triangle(const std::vector<ConvexBody>& bodies, const TriangleMesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    if (std::ranges::none_of(bodies, [&](const ConvexBody& b) { return holds(b, triangle); })) {
      return false;
    }
  }
  return true;
}

}  // namespace

ConvexPieces convex_pieces(const std::vector<TriangleMesh>& shells, const OpenSpace& space,
                           const PartLimits& limits) {
  const std::vector<OpenPoint> open = space.points(kOpenShare * limits.tolerance);
  ConvexPieces pieces;
  pieces.shells = shells.size();
  std::vector<ConvexCell> others;
  for (const TriangleMesh& shell : shells) {
    ConvexCell cell = ConvexCell::around(shell);
    if (is_convex(shell, limits.tolerance)) {
      pieces.cells.push_back(std::move(cell));
      continue;
    }
    Walls walls =
        walls_of(cell, space, open, limits.max_parts, kSafe * kOverlap * limits.tolerance);
    for (ConvexCell& wall : walls.cells) pieces.cells.push_back(std::move(wall));
    if (walls.rest) others.push_back(*std::move(walls.rest));
  }
  pieces.convex = pieces.cells.size();
  for (ConvexCell& other : others) pieces.cells.push_back(std::move(other));
  return pieces;
}

std::vector<ConvexBody> exact_parts(const ConvexPieces& pieces, const TriangleMesh& mesh,
                                    const OpenSpace& space) {
  if (pieces.convex < pieces.cells.size()) return {};
  std::vector<ConvexBody> bodies;
  for (const ConvexCell& cell : pieces.cells) {
    auto hull = hull_of(cell.is_whole() ? cell.mesh->vertices : points_in(cell, space));
    if (!hull) return {};
    bodies.push_back(*std::move(hull));
  }
  remove_inner(bodies);
  return hold_each_triangle(bodies, mesh) ? std::move(bodies) : std::vector<ConvexBody>();
}

}  // namespace clearance
