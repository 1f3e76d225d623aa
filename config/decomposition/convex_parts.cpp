#include "config/decomposition/convex_parts.hpp"

#include <algorithm>
#include <utility>

#include "config/decomposition/part_search.hpp"
#include "config/decomposition/surface_error.hpp"
#include "config/decomposition/triangle_tree.hpp"

namespace clearance {
namespace {

// A hull of up to this many facets stays as it is. It has the mesh's own vertices, and no error
// where the mesh is convex.
constexpr std::size_t kFacetsOfOne = 400;
// The search aims below the tolerance, since it estimates the error. If the certified error still
// exceeds the tolerance, it aims lower again.
constexpr double kAim = 0.85, kLowerAim = 0.9;
constexpr int kAims = 3;

struct Bodies {
  std::vector<ConvexBody> parts;
  double error = kInfinity;
  bool is_hull = false;
};

ConvexParts vertices_of(const Bodies& bodies) {
  ConvexParts result{{}, bodies.error, bodies.is_hull};
  for (const ConvexBody& part : bodies.parts) {
    result.parts.emplace_back();
    for (const Vertex& vertex : part.vertices) result.parts.back().push_back(vertex.position);
  }
  return result;
}

Bodies judged(std::vector<ConvexBody> parts, const TriangleTree& tree) {
  const double error = surface_error(parts, tree);
  return {std::move(parts), error, false};
}

// Returns one part, with as few facets as the tolerance allows.
Bodies one_part(ConvexBody hull, const TriangleTree& tree, double tolerance) {
  Bodies whole = judged({std::move(hull)}, tree);
  whole.is_hull = true;
  if (whole.parts[0].facets.size() <= kFacetsOfOne) return whole;
  Bodies fewer = judged({with_fewer_facets(whole.parts[0], tolerance)}, tree);
  return fewer.error <= std::max(tolerance, whole.error) ? fewer : whole;
}

Bodies several_parts(const TriangleMesh& mesh, const TriangleTree& tree, const PartLimits& limits) {
  PartSearch search(mesh, limits);
  Bodies best;
  double aim = kAim * limits.tolerance;
  for (int round = 0; round < kAims && best.error > limits.tolerance; ++round) {
    Bodies found = judged(search.parts(aim), tree);
    const bool no_more = found.parts.size() >= limits.max_parts;
    aim *= std::clamp(kLowerAim * limits.tolerance / found.error, 0.5, 0.9);
    if (found.error < best.error) best = std::move(found);
    if (no_more) break;
  }
  return best;
}

}  // namespace

std::variant<ConvexParts, ShapeError> convex_parts(const TriangleMesh& mesh,
                                                   const PartLimits& limits,
                                                   const std::function<void()>& begin) {
  ShapeResult hull = polyhedron_from_vertices(mesh.vertices);
  if (auto* error = std::get_if<ShapeError>(&hull)) return std::move(*error);
  const TriangleTree tree(mesh);
  Bodies bodies = one_part(std::get<ConvexBody>(std::move(hull)), tree, limits.tolerance);
  if (bodies.error > limits.tolerance && limits.max_parts > 1) {
    begin();
    Bodies split = several_parts(mesh, tree, limits);
    if (split.error < bodies.error) bodies = std::move(split);
  }
  return vertices_of(bodies);
}

}  // namespace clearance
