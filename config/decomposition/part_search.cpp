#include "config/decomposition/part_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "config/decomposition/cuts.hpp"
#include "config/decomposition/in_parallel.hpp"
#include "config/decomposition/large_faces.hpp"
#include "config/decomposition/rough_hull.hpp"
#include "core/enclosing_polyhedron.hpp"

namespace clearance {
namespace {

// Shares of the tolerance.
constexpr double kLeastOpen = 0.3;    // points nearer to the mesh are no error
constexpr double kSimplified = 0.06;  // the largest distance by which vertices of a body with fewer
                                      // facets may exceed it

constexpr std::size_t kFacets = 96;  // of a part, at most
// A hull of at most this many times the facets of the body around it stays as it is. Bodies of 96
// planes have up to 372 facets, since their vertices are rounded. Over the links of four robots,
// 1.5 leaves as many facets in all as no limit does; larger ones bring no nearer bounds.
constexpr double kWorthFewer = 1.5;
constexpr std::size_t kFacetsOfShell = 32;  // of a whole shell's hull that is kept as it is
constexpr std::size_t kPiecesAPart = 3;
// A cut is of no use if a side keeps more than this share of the error. After so many in a row,
// the search has got stuck.
constexpr double kNoGain = 0.98;
constexpr int kMostUseless = 12;
constexpr std::size_t kUsualParts = 24;  // the search does not depend on lower numbers allowed

// A share of a body's size: more than clipping and rounding can move a point, and negligible as a
// distance.
constexpr double kMargin = 0x1p-30;

std::vector<Vec3> vertices_of(const ConvexBody& body) {
  std::vector<Vec3> vertices;
  for (const Vertex& vertex : body.vertices) vertices.push_back(vertex.position);
  return vertices;
}

// Returns the vertices of cubes of this half width around points that lie in one plane.
std::vector<Vec3> thickened(const std::vector<Vec3>& points, double by) {
  std::vector<Vec3> corners;
  for (const Vec3& point : points) {
    for (int k = 0; k < 8; ++k) {
      corners.push_back(
          point + by * Vec3((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1));
    }
  }
  return corners;
}

std::optional<ConvexBody> body_of(const std::vector<Vec3>& points) {
  ShapeResult made = polyhedron_from_vertices(points);
  auto* body = std::get_if<ConvexBody>(&made);
  return body == nullptr ? std::nullopt : std::optional(std::move(*body));
}

}  // namespace

std::optional<ConvexBody> with_fewer_facets(ConvexBody hull, double tolerance) {
  const double size = hull.bounding_radius;
  hull.radius = kMargin * size;
  const PlacedShape placed{&hull, {}};
  const auto fewer = enclosing_polyhedron(
      {&placed, 1}, {.facets = kFacets, .tolerance = kSimplified * tolerance / size});
  // A body's vertices are rounded once more than its planes, so this one is the hull of the
  // vertices.
  auto body = fewer ? body_of(vertices_of(*fewer)) : std::nullopt;
  if (!body) return std::nullopt;
  const double worth = kWorthFewer * static_cast<double>(body->facets.size());
  return static_cast<double>(hull.facets.size()) > worth ? std::move(body) : std::nullopt;
}

PartSearch::PartSearch(const TriangleMesh& mesh, const OpenSpace& space,
                       std::span<const ConvexCell> cells, const PartLimits& limits,
                       CutChoice choice)
    : limits_(limits),
      choice_(choice),
      space_(space),
      faces_(large_faces(mesh, limits.tolerance)),
      open_(space.points(kLeastOpen * limits.tolerance)) {
  // Points outside the hull of the whole are no error of any part.
  open_ = piece_of(ConvexCell::around(mesh)).open;
  open_blocks_ = OpenBlocks(open_, space.spacing());
  for (const ConvexCell& cell : cells) pieces_.push_back(piece_of(cell));
}

// Returns the points of the mesh in the cell, one a cell of the open space's grid, and where it
// crosses the cell's planes.
Piece PartSearch::piece_of(const ConvexCell& cell) const {
  Piece piece;
  piece.cells = {cell};
  const double spacing = space_.spacing(), overlap = kOverlap * limits_.tolerance;
  std::vector<std::pair<std::array<long, 3>, Vec3>> points;
  const auto add = [&](const Vec3& point) {
    points.emplace_back(
        std::array{std::lround(point.x() / spacing), std::lround(point.y() / spacing),
                   std::lround(point.z() / spacing)},
        point);
  };
  for (const Vec3& vertex : cell.mesh->vertices) add(vertex);
  for (std::size_t i = 0; i < cell.mesh->triangles.size(); ++i) {
    subdivide(cell.mesh->triangle(i), 4.0 * spacing, [&](const Triangle& t) {
      for (const Vec3& corner : t) add(corner);
    });
  }
  std::ranges::stable_sort(points, [](const auto& a, const auto& b) { return a.first < b.first; });
  const std::span cuts = std::span(cell.planes).subspan(ConvexCell::kBoxPlanes);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0 && points[i].first == points[i - 1].first) continue;
    if (holds(cuts, points[i].second, overlap)) piece.points.push_back(points[i].second);
  }
  for (const HalfSpace& plane : cuts) add_rim(plane, piece);
  const std::vector<Vec3> corners = cell.corners_within(space_, overlap);
  piece.points.insert(piece.points.end(), corners.begin(), corners.end());
  piece.finish(open_, spacing);
  return piece;
}

// Adds points where the mesh crosses a plane of the piece. They lie between points of the mesh, and
// are often vertices of the piece's hull.
void PartSearch::add_rim(const HalfSpace& plane, Piece& piece) const {
  const double near = 1e-6 * space_.spacing();
  const auto above = [&](const Vec3& point) { return plane.normal.dot(point) - plane.offset; };
  const TriangleMesh& mesh = *piece.cells[0].mesh;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    const double heights[] = {above(triangle[0]), above(triangle[1]), above(triangle[2])};
    const auto [low, high] = std::ranges::minmax(heights);
    if (low > 0.0 || high < 0.0) continue;
    for (const Vec3& point : clipped(triangle, piece.cells[0], 0.0)) {
      if (std::abs(above(point)) <= near) piece.points.push_back(point);
    }
  }
}

std::optional<std::pair<Piece, Piece>> PartSearch::cut(const Piece& piece) const {
  const auto plane = best_cut(piece, faces_, choice_, limits_.tolerance, space_.spacing());
  if (!plane) return std::nullopt;
  std::pair<Piece, Piece> sides;
  const double overlap = kOverlap * limits_.tolerance;
  for (const Vec3& point : piece.points) {
    const double above = plane->normal.dot(point) - plane->offset;
    if (above <= overlap) sides.first.points.push_back(point);
    if (above >= -overlap) sides.second.points.push_back(point);
  }
  sides.first.cells = sides.second.cells = piece.cells;
  sides.first.cells[0].cut_by(*plane);
  sides.second.cells[0].cut_by({-plane->normal, -plane->offset});
  for (Piece* side : {&sides.first, &sides.second}) {
    const std::vector<Vec3> corners = side->cells[0].corners_within(space_, overlap);
    side->points.insert(side->points.end(), corners.begin(), corners.end());
    add_rim(*plane, *side);
    side->finish(piece.open, space_.spacing());
    side->useless_cuts = side->error > kNoGain * piece.error ? piece.useless_cuts + 1 : 0;
  }
  return sides;
}

// The worst piece is split first.
void PartSearch::split(double aim) {
  const std::size_t most = kPiecesAPart * std::max(kUsualParts, limits_.max_parts);
  for (;;) {
    const auto worst = std::ranges::max_element(pieces_, {}, &Piece::error);
    if (worst->error <= aim) return;
    const bool too_many = pieces_.size() >= most;
    is_stuck_ |=
        choice_ == CutChoice::kLeastOpen &&
        (worst->useless_cuts >= kMostUseless || (too_many && worst->error > limits_.tolerance));
    if (too_many || is_stuck_) return;
    auto sides = cut(*worst);
    if (!sides) return;
    *worst = std::move(sides->first);
    pieces_.push_back(std::move(sides->second));
  }
}

// Returns the estimated error of the hull of both.
double PartSearch::joint_error(const Piece& a, const Piece& b) const {
  Outline outline = a.outline;
  outline.add(b.outline);
  const std::vector<Vec3> points = outline.points();
  const double near = 0.5 * space_.spacing();
  Eigen::AlignedBox3d box;
  for (const Vec3& point : points) box.extend(point);
  box.extend(box.max() + Vec3::Constant(near));
  box.extend(box.min() - Vec3::Constant(near));
  const std::vector<HalfSpace> hull = rough_hull(points);
  return std::max(0.0, open_blocks_.farthest_in(hull, box, near) - near);
}

// Estimates the error of each pair of joined pieces that has no estimate yet.
void PartSearch::estimate_joints() {
  std::vector<std::pair<std::size_t, std::size_t>> unknown;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!joints_[i][j]) unknown.emplace_back(i, j);
    }
  }
  in_parallel(unknown.size(), [&](std::size_t k) {
    const auto [i, j] = unknown[k];
    joints_[i][j] = joint_error(joined_[i].piece, joined_[j].piece);
  });
}

// Joins the two pieces whose common hull has the least error, if that is at most `most`.
bool PartSearch::join_best(double most) {
  if (joined_.size() < 2) return false;
  estimate_joints();
  std::size_t first = 0, second = 1;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (joints_[i][j] < joints_[second][first]) {
        first = j;
        second = i;
      }
    }
  }
  const double error = *joints_[second][first];
  if (error > most) return false;
  Joined& joined = joined_[first];
  const Piece& other = joined_[second].piece;
  joined.piece.cells.insert(joined.piece.cells.end(), other.cells.begin(), other.cells.end());
  joined.piece.outline.add(other.outline);
  joined.piece.error = error;
  joined.has_body = false;
  const auto gone = static_cast<std::ptrdiff_t>(second);
  joined_.erase(joined_.begin() + gone);
  joints_.erase(joints_.begin() + gone);
  for (std::size_t i = second; i < joints_.size(); ++i) {
    joints_[i].erase(joints_[i].begin() + gone);
  }
  std::ranges::fill(joints_[first], std::nullopt);
  for (std::size_t i = first + 1; i < joints_.size(); ++i) joints_[i][first].reset();
  return true;
}

bool PartSearch::search(double aim) {
  split(aim);
  const double worst = std::ranges::max_element(pieces_, {}, &Piece::error)->error;
  if (is_stuck_ && worst > limits_.tolerance) return false;
  joined_.clear();
  for (const Piece& piece : pieces_) joined_.push_back({piece});
  joints_.assign(joined_.size(), {});
  for (std::size_t i = 0; i < joints_.size(); ++i) joints_[i].resize(i);
  while (join_best(joined_.size() > limits_.max_parts ? kInfinity : aim)) {
  }
  return true;
}

// Returns the vertices of every triangle, clipped by the piece's cells, and those vertices of the
// cells that belong to no triangle. The part of the mesh in the cells lies in their hull.
std::vector<Vec3> PartSearch::points_of(const Piece& piece) const {
  const double overlap = kOverlap * limits_.tolerance;
  std::vector<Vec3> points;
  for (const ConvexCell& cell : piece.cells) {
    if (cell.is_whole()) {
      points.insert(points.end(), cell.mesh->vertices.begin(), cell.mesh->vertices.end());
      continue;
    }
    for (std::size_t i = 0; i < cell.mesh->triangles.size(); ++i) {
      const auto polygon = clipped(cell.mesh->triangle(i), cell, overlap);
      points.insert(points.end(), polygon.begin(), polygon.end());
    }
    const std::vector<Vec3> corners = cell.corners_within(space_, overlap);
    points.insert(points.end(), corners.begin(), corners.end());
  }
  return points;
}

// The hull of whole shells stays as it is if it has few facets. Any other hull stays as it is where
// a body around it would save little.
std::optional<ConvexBody> PartSearch::body_of_piece(const Piece& piece,
                                                    const std::vector<Vec3>& points) const {
  auto hull = body_of(points);
  if (!hull) hull = body_of(thickened(points, kOverlap * limits_.tolerance));
  if (!hull) return std::nullopt;
  const bool is_whole = std::ranges::all_of(piece.cells, &ConvexCell::is_whole);
  if (is_whole && hull->facets.size() <= kFacetsOfShell) return hull;
  auto fewer = with_fewer_facets(*hull, limits_.tolerance);
  return fewer ? std::move(fewer) : std::move(hull);
}

std::vector<ConvexBody> PartSearch::parts() {
  in_parallel(joined_.size(), [&](std::size_t i) {
    Joined& joined = joined_[i];
    if (std::exchange(joined.has_body, true)) return;
    const std::vector<Vec3> points = points_of(joined.piece);
    joined.is_empty = points.empty();
    joined.body = joined.is_empty ? std::nullopt : body_of_piece(joined.piece, points);
  });
  std::vector<ConvexBody> parts;
  for (const Joined& joined : joined_) {
    if (joined.is_empty) continue;
    if (!joined.body) return {};
    parts.push_back(*joined.body);
  }
  return parts;
}

}  // namespace clearance
