#include "config/decomposition/convex_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "config/decomposition/exact_parts.hpp"
#include "config/decomposition/part_search.hpp"
#include "config/decomposition/plate.hpp"
#include "config/decomposition/shells.hpp"
#include "config/decomposition/surface_error.hpp"
#include "config/decomposition/triangle_tree.hpp"

namespace clearance {
namespace {

// The hull of a whole mesh stays as it is up to this many facets. It has the mesh's own vertices,
// and no error where the mesh is convex.
constexpr std::size_t kFacetsOfOne = 400;
// The search aims below the tolerance, since it estimates the error. If the certified error still
// exceeds the tolerance, it aims lower again.
constexpr double kAim = 0.85, kLowerAim = 0.9;
constexpr int kAims = 3;

// Shares of the tolerance.
constexpr double kBall = 0.75;     // openings narrower than such a ball count as closed
constexpr double kPrecise = 2e-3;  // to which errors are found
constexpr double kExact = 0.1;     // parts that come so near need no search for fewer
constexpr std::size_t kMostShells = 100;

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

Bodies judged(std::vector<ConvexBody> parts, const TriangleTree& tree, double tolerance,
              double enough = kInfinity) {
  if (parts.empty()) return {};
  const double error = surface_error(parts, tree, kPrecise * tolerance, enough);
  return {std::move(parts), error, false};
}

// Returns one part, with as few facets as the tolerance allows.
Bodies one_part(ConvexBody hull, const TriangleTree& tree, double tolerance) {
  Bodies whole = judged({std::move(hull)}, tree, tolerance);
  whole.is_hull = true;
  if (whole.parts[0].facets.size() <= kFacetsOfOne) return whole;
  auto body = with_fewer_facets(whole.parts[0], tolerance);
  if (!body) return whole;
  Bodies fewer = judged({*std::move(body)}, tree, tolerance);
  return fewer.error <= std::max(tolerance, whole.error) ? fewer : whole;
}

// Fewer parts within the tolerance are better, and otherwise the smaller error.
bool is_no_worse(const Bodies& bodies, const Bodies& other, double tolerance) {
  if (bodies.error <= tolerance && other.error <= tolerance) {
    return bodies.parts.size() <= other.parts.size();
  }
  return bodies.error <= other.error;
}

// A lower number of parts is tried as well where the error is too large: joining may leave less.
void improve(PartSearch& search, const TriangleTree& tree, double tolerance, Bodies& best) {
  while (best.error > tolerance && search.join_best(best.error)) {
    Bodies found = judged(search.parts(), tree, tolerance, best.error);
    if (found.error < best.error) best = std::move(found);
  }
}

Bodies found_by(PartSearch& search, const TriangleTree& tree, const PartLimits& limits) {
  Bodies best;
  double aim = kAim * limits.tolerance;
  for (int round = 0; round < kAims && best.error > limits.tolerance; ++round) {
    if (!search.search(aim)) break;
    Bodies found = judged(search.parts(), tree, limits.tolerance, best.error);
    const bool no_more = found.parts.size() >= limits.max_parts;
    aim *= std::clamp(kLowerAim * limits.tolerance / found.error, 0.5, 0.9);
    if (found.error < best.error) best = std::move(found);
    if (search.is_stuck()) break;
    if (no_more) improve(search, tree, limits.tolerance, best);
    if (no_more) break;
  }
  return best;
}

// The cuts that leave the least open space give the fewest parts of most meshes. They make no
// progress in rings and cups, because each of them removes only a thin layer.
Bodies searched_parts(const TriangleMesh& mesh, const TriangleTree& tree, const OpenSpace& space,
                      std::span<const ConvexCell> cells, const PartLimits& limits) {
  PartSearch search(mesh, space, cells, limits);
  Bodies best = found_by(search, tree, limits);
  if (best.error <= limits.tolerance || !search.is_stuck()) return best;
  PartSearch even(mesh, space, cells, limits, CutChoice::kEven);
  Bodies other = found_by(even, tree, limits);
  return is_no_worse(other, best, limits.tolerance) ? other : best;
}

// Shells that are not convex often lie within each other, and are then better cut together. Where
// some shells are convex, these are also kept whole and only the others cut, unless the parts would
// be too many.
Bodies parts_of_pieces(const TriangleMesh& mesh, const TriangleTree& tree, const OpenSpace& space,
                       const ConvexPieces& pieces, const PartLimits& limits) {
  const auto searched = [&](std::span<const ConvexCell> cells) {
    return searched_parts(mesh, tree, space, cells, limits);
  };
  if (pieces.convex == pieces.cells.size() || pieces.shells == 1) return searched(pieces.cells);
  const ConvexCell whole = ConvexCell::around(mesh);
  Bodies together = searched({&whole, 1});
  const std::size_t most =
      together.error <= limits.tolerance ? together.parts.size() : limits.max_parts;
  if (pieces.convex == 0 || pieces.convex >= most) return together;
  Bodies kept = searched(pieces.cells);
  return is_no_worse(kept, together, limits.tolerance) ? kept : together;
}

// Exact parts come first. A mesh of very many shells is searched as a whole.
Bodies several_parts(const TriangleMesh& mesh, const TriangleTree& tree, const PartLimits& limits) {
  const OpenSpace space(mesh, kBall * limits.tolerance);
  const std::vector<TriangleMesh> shells = shells_of(mesh);
  if (shells.size() > kMostShells) {
    const ConvexCell whole = ConvexCell::around(mesh);
    return searched_parts(mesh, tree, space, {&whole, 1}, limits);
  }
  const ConvexPieces pieces = convex_pieces(shells, space, limits);
  std::vector<ConvexBody> exact = exact_parts(pieces, mesh, space);
  if (!exact.empty() && exact.size() <= limits.max_parts) {
    Bodies bodies = judged(std::move(exact), tree, limits.tolerance);
    if (bodies.error <= kExact * limits.tolerance) return bodies;
  }
  return parts_of_pieces(mesh, tree, space, pieces, limits);
}

// Returns a prism around each triangle. Prisms are shells, so no part divides one. If they are too
// many for that, the flat mesh itself is added, so that the parts hold it in any case.
TriangleMesh plate_of(const TriangleMesh& flat, const Vec3& normal, double thickness) {
  const Vec3 up = 0.5 * thickness * normal;
  TriangleMesh plate;
  for (const Vec3& v : flat.vertices) {
    plate.vertices.push_back(v - up);
    plate.vertices.push_back(v + up);
  }
  for (const auto& [a, b, c] : flat.triangles) {
    plate.triangles.push_back({2 * a, 2 * c, 2 * b});
    plate.triangles.push_back({2 * a + 1, 2 * b + 1, 2 * c + 1});
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      plate.triangles.push_back({2 * from, 2 * to, 2 * to + 1});
      plate.triangles.push_back({2 * from, 2 * to + 1, 2 * from + 1});
    }
  }
  if (flat.triangles.size() <= kMostShells) return plate;
  const auto first = static_cast<std::uint32_t>(plate.vertices.size());
  plate.vertices.insert(plate.vertices.end(), flat.vertices.begin(), flat.vertices.end());
  for (const auto& [a, b, c] : flat.triangles) {
    plate.triangles.push_back({first + a, first + b, first + c});
  }
  return plate;
}

std::variant<ConvexParts, ShapeError> parts_of_solid(const TriangleMesh& mesh,
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

}  // namespace

// A plate counts as a solid, however thin it is.
std::variant<ConvexParts, ShapeError> convex_parts(const TriangleMesh& mesh,
                                                   const PartLimits& limits,
                                                   const std::function<void()>& begin) {
  const auto normal = plane_of(mesh.vertices, limits.plate);
  if (!normal) return parts_of_solid(mesh, limits, begin);
  auto parts = parts_of_solid(plate_of(mesh, *normal, limits.plate), limits, begin);
  // The parts are as near to the plate as stated, and the plate to the mesh.
  if (auto* made = std::get_if<ConvexParts>(&parts)) made->error += 0.5 * limits.plate;
  return parts;
}

}  // namespace clearance
