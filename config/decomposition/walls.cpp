#include "config/decomposition/walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "config/decomposition/polygon.hpp"
#include "config/decomposition/rough_hull.hpp"

namespace clearance {
namespace {

// A mesh of more triangles is no designed box, and trying its planes would take too long.
constexpr std::size_t kMostTriangles = 5000;
// Faces with a smaller share of the surface are not tried: those of a round wall are many.
constexpr double kLeastFace = 0.02;
constexpr double kLeastShare = 0.005;  // of the surface: smaller walls are not cut off
// Relative to the size: coordinates have single precision, so the vertices of a flat face are not
// quite in one plane.
constexpr double kOnPlane = 2e-7;
constexpr double kStepBeside = 1e-4;
constexpr double kSameNormal = 1e-4, kSameOffset = 1e-5;
// The grid's points have distances from samples of the mesh; relative to their spacing.
constexpr double kNearMesh = 0.75;
constexpr std::size_t kFewOpen = 1500;  // points that rule out most cuts

double size_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  return box.diagonal().norm();
}

std::vector<Polygon> triangles_of(const TriangleMesh& mesh) {
  std::vector<Polygon> polygons;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    polygons.emplace_back(t.begin(), t.end());
  }
  return polygons;
}

double area_of_all(const std::vector<Polygon>& polygons) {
  double area = 0.0;
  for (const Polygon& polygon : polygons) area += area_of(polygon);
  return area;
}

// Returns the planes of flat faces, the largest first. A plane is that of its largest triangle.
std::vector<HalfSpace> planes_of(const TriangleMesh& mesh) {
  struct FlatFace {
    double area = 0.0, largest = 0.0;
    HalfSpace plane{};
  };
  const double step = kSameOffset * size_of(mesh);
  std::map<std::array<long, 4>, FlatFace> faces;
  double all = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double area = 0.5 * normal.norm();
    if (!(area > 0.0)) continue;
    all += area;
    normal.normalize();
    Eigen::Index axis = 0;
    normal.cwiseAbs().maxCoeff(&axis);
    if (normal[axis] < 0.0) normal = -normal;
    const double offset = normal.dot(t[0]);
    const std::array key = {std::lround(normal.x() / kSameNormal),
                            std::lround(normal.y() / kSameNormal),
                            std::lround(normal.z() / kSameNormal), std::lround(offset / step)};
    FlatFace& face = faces[key];
    face.area += area;
    if (area <= face.largest) continue;
    face.largest = area;
    face.plane = {normal, offset};
  }
  std::vector<FlatFace> large;
  for (const auto& [key, face] : faces) {
    if (face.area >= kLeastFace * all) large.push_back(face);
  }
  std::ranges::stable_sort(large,
                           [](const FlatFace& a, const FlatFace& b) { return a.area > b.area; });
  std::vector<HalfSpace> planes;
  for (const FlatFace& face : large) planes.push_back(face.plane);
  return planes;
}

// Tells whether the mesh winds around the point (A. van Oosterom and J. Strackee, "The solid angle
// of a plane triangle", 1983). For a closed mesh the sum is 1 inside and 0 outside.
bool winds_around(const TriangleMesh& mesh, const Vec3& point) {
  double sum = 0.0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangle(i);
    const Vec3 a = t[0] - point, b = t[1] - point, c = t[2] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return std::abs(sum) > std::numbers::pi;
}

// Returns what of the polygon is on the inner side of the plane. A polygon in the plane belongs to
// the side where the solid is, which is behind it.
Polygon inside_of(const Polygon& polygon, const HalfSpace& plane, double on_plane) {
  const bool is_in_plane = std::ranges::all_of(polygon, [&](const Vec3& vertex) {
    return std::abs(plane.normal.dot(vertex) - plane.offset) <= on_plane;
  });
  if (!is_in_plane) return cut_by(polygon, plane, on_plane).inside;
  const Vec3 normal = (polygon[1] - polygon[0]).cross(polygon[2] - polygon[0]);
  return normal.dot(plane.normal) >= 0.0 ? polygon : Polygon();
}

// Returns the vertices of the cell around which the solid lies in the cell. `points`: some of the
// piece.
std::vector<Vec3> corners_in_solid(const ConvexCell& cell, const OpenSpace& space,
                                   const std::vector<Vec3>& points) {
  std::vector<Vec3> corners = cell.corners_within(space, 0.0);
  if (corners.empty() || points.empty()) return {};
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : points) middle += point / static_cast<double>(points.size());
  // A vertex often lies on the mesh: a point beside it tells on which side the solid is.
  const double step = kStepBeside * size_of(*cell.mesh);
  std::erase_if(corners, [&](const Vec3& corner) {
    return !winds_around(*cell.mesh, corner + step * (middle - corner).normalized());
  });
  return corners;
}

std::vector<Vec3> vertices_of(const std::vector<Polygon>& polygons) {
  std::vector<Vec3> points;
  for (const Polygon& polygon : polygons) {
    points.insert(points.end(), polygon.begin(), polygon.end());
  }
  return points;
}

struct Side {
  HalfSpace plane;  // the side is n.x <= d
  std::vector<Polygon> polygons;
  double area = 0.0;
};

class WallCutter {
 public:
  WallCutter(const ConvexCell& whole, const OpenSpace& space, const std::vector<OpenPoint>& open)
      : whole_(whole),
        space_(space),
        open_(open),
        on_plane_(kOnPlane * size_of(*whole.mesh)),
        planes_(planes_of(*whole.mesh)) {
    const std::size_t step = open.size() / kFewOpen + 1;
    for (std::size_t i = 0; i < open.size(); i += step) few_.push_back(open[i]);
  }

  Walls walls(std::size_t most) {
    Walls found;
    ConvexCell cell = whole_;
    std::vector<Polygon> polygons = triangles_of(*whole_.mesh);
    const double least = kLeastShare * area_of_all(polygons);
    while (!is_convex(cell, polygons)) {
      auto wall =
          found.cells.size() + 1 < most ? largest_wall(cell, polygons, least) : std::nullopt;
      if (!wall) {
        found.rest = cell;
        break;
      }
      found.cells.push_back(beside(cell, wall->plane));
      const HalfSpace other{-wall->plane.normal, -wall->plane.offset};
      polygons = side_of(polygons, other).polygons;
      cell = beside(cell, other);
    }
    if (!found.rest) found.cells.push_back(std::move(cell));
    if (found.cells.size() > 1 || found.rest) {
      for (ConvexCell& wall : found.cells) grow(wall);
    }
    return found;
  }

 private:
  static ConvexCell beside(ConvexCell cell, const HalfSpace& plane) {
    cell.planes.push_back(plane);
    return cell;
  }

  [[nodiscard]] Side side_of(const std::vector<Polygon>& polygons, const HalfSpace& plane) const {
    Side side{plane, {}};
    for (const Polygon& polygon : polygons) {
      Polygon inside = inside_of(polygon, plane, on_plane_);
      if (inside.size() < 3) continue;
      side.area += area_of(inside);
      side.polygons.push_back(std::move(inside));
    }
    return side;
  }

  [[nodiscard]] std::optional<Side> largest_wall(const ConvexCell& cell,
                                                 const std::vector<Polygon>& polygons,
                                                 double least) const {
    std::optional<Side> best;
    const double all = area_of_all(polygons);
    for (const HalfSpace& plane : planes_) {
      for (const double turn : {1.0, -1.0}) {
        Side side = side_of(polygons, {turn * plane.normal, turn * plane.offset});
        if (side.area < least || side.area > all - least || (best && side.area <= best->area)) {
          continue;
        }
        if (is_convex(beside(cell, side.plane), side.polygons)) best = std::move(side);
      }
    }
    return best;
  }

  [[nodiscard]] bool is_convex(const ConvexCell& cell, const std::vector<Polygon>& polygons) const {
    Outline outline;
    const std::vector<Vec3> points = vertices_of(polygons);
    for (const Vec3& point : points) outline.add(point);
    for (const Vec3& point : corners_in_solid(cell, space_, points)) outline.add(point);
    const std::vector<HalfSpace> hull = rough_hull(outline.points());
    if (hull.empty()) return false;
    return holds_none(hull, few_) && holds_none(hull, open_);
  }

  [[nodiscard]] bool holds_none(const std::vector<HalfSpace>& hull,
                                const std::vector<OpenPoint>& open) const {
    const double half = 0.5 * space_.spacing(), near = kNearMesh * space_.spacing();
    return std::ranges::none_of(open, [&](const OpenPoint& point) {
      return point.distance - half > near && holds(hull, point.position, half);
    });
  }

  [[nodiscard]] std::vector<Polygon> polygons_in(const ConvexCell& cell) const {
    std::vector<Polygon> polygons = triangles_of(*cell.mesh);
    for (std::size_t k = ConvexCell::kBoxPlanes; k < cell.planes.size(); ++k) {
      polygons = side_of(polygons, cell.planes[k]).polygons;
    }
    return polygons;
  }

  // Drops those planes of the cell that are not needed to make the piece convex, or replaces them
  // by one that leaves more of the solid to it.
  void grow(ConvexCell& cell) const {
    for (std::size_t i = cell.planes.size(); i-- > ConvexCell::kBoxPlanes;) {
      const std::vector<Polygon> piece = polygons_in(cell);
      ConvexCell larger = cell;
      larger.planes.erase(larger.planes.begin() + static_cast<std::ptrdiff_t>(i));
      const std::vector<Polygon> polygons = polygons_in(larger);
      if (is_convex(larger, polygons)) {
        cell = std::move(larger);
      } else if (const auto other = largest_side_with(piece, larger, polygons)) {
        cell = beside(std::move(larger), *other);
      }
    }
  }

  // Returns the plane that leaves a convex piece of the cell, larger than `piece`, which it holds.
  [[nodiscard]] std::optional<HalfSpace> largest_side_with(
      const std::vector<Polygon>& piece, const ConvexCell& cell,
      const std::vector<Polygon>& polygons) const {
    std::optional<HalfSpace> best;
    double most = (1.0 + kLeastShare) * area_of_all(piece);
    for (const HalfSpace& plane : planes_) {
      for (const double turn : {1.0, -1.0}) {
        const HalfSpace half{turn * plane.normal, turn * plane.offset};
        const bool holds_piece = std::ranges::all_of(piece, [&](const Polygon& polygon) {
          return std::ranges::all_of(polygon, [&](const Vec3& vertex) {
            return half.normal.dot(vertex) <= half.offset + on_plane_;
          });
        });
        if (!holds_piece) continue;
        const Side side = side_of(polygons, half);
        if (side.area <= most || !is_convex(beside(cell, half), side.polygons)) continue;
        most = side.area;
        best = half;
      }
    }
    return best;
  }

  const ConvexCell& whole_;
  const OpenSpace& space_;
  const std::vector<OpenPoint>& open_;
  double on_plane_;  // m
  std::vector<HalfSpace> planes_;
  std::vector<OpenPoint> few_;
};

bool hold_mesh(std::vector<ConvexCell> cells, const TriangleMesh& mesh, double margin) {
  for (ConvexCell& cell : cells) {
    for (HalfSpace& plane : cell.planes) plane.offset += margin;
  }
  std::vector<Polygon> next;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle triangle = mesh.triangle(i);
    std::vector<Polygon> left = {{triangle.begin(), triangle.end()}};
    for (const ConvexCell& cell : cells) {
      next.clear();
      for (const Polygon& polygon : left) subtract(polygon, cell.planes, next);
      left.swap(next);
    }
    if (!left.empty()) return false;
  }
  return true;
}

}  // namespace

Walls walls_of(const ConvexCell& whole, const OpenSpace& space, const std::vector<OpenPoint>& open,
               std::size_t most, double margin) {
  if (whole.mesh->triangles.size() > kMostTriangles) return {{}, whole};
  Walls walls = WallCutter(whole, space, open).walls(most);
  std::vector<ConvexCell> cells = walls.cells;
  if (walls.rest) cells.push_back(*walls.rest);
  return hold_mesh(std::move(cells), *whole.mesh, margin) ? std::move(walls) : Walls{{}, whole};
}

std::vector<Vec3> points_in(const ConvexCell& cell, const OpenSpace& space) {
  const double on_plane = kOnPlane * size_of(*cell.mesh);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < cell.mesh->triangles.size(); ++i) {
    const Triangle t = cell.mesh->triangle(i);
    Polygon polygon(t.begin(), t.end());
    for (std::size_t k = ConvexCell::kBoxPlanes; k < cell.planes.size() && polygon.size() > 2;
         ++k) {
      polygon = inside_of(polygon, cell.planes[k], on_plane);
    }
    if (polygon.size() > 2) points.insert(points.end(), polygon.begin(), polygon.end());
  }
  const std::vector<Vec3> corners = corners_in_solid(cell, space, points);
  points.insert(points.end(), corners.begin(), corners.end());
  return points;
}

}  // namespace clearance
