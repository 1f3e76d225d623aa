#include "config/decomposition/piece.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "config/decomposition/rough_hull.hpp"

namespace clearance {
namespace {

// Returns the axes in both directions, then a spiral over the sphere.
std::array<Vec3, kDirections> spread_directions() {
  std::array<Vec3, kDirections> directions;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    directions[2 * axis] = Vec3::Unit(static_cast<Eigen::Index>(axis));
    directions[2 * axis + 1] = -directions[2 * axis];
  }
  constexpr std::size_t kSpiral = kDirections - 6;
  const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (std::size_t i = 0; i < kSpiral; ++i) {
    const double z = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / kSpiral;
    const double ring = std::sqrt(1.0 - z * z), angle = turn * static_cast<double>(i);
    directions[6 + i] = {ring * std::cos(angle), ring * std::sin(angle), z};
  }
  return directions;
}

const std::array<Vec3, kDirections>& directions() {
  static const std::array<Vec3, kDirections> all = spread_directions();
  return all;
}

}  // namespace

Outline::Outline() { support_value_.fill(-std::numeric_limits<double>::infinity()); }

void Outline::add(const Vec3& point) {
  const auto& all = directions();
  for (std::size_t k = 0; k < kDirections; ++k) {
    const double value = all[k].dot(point);
    if (value <= support_value_[k]) continue;
    support_value_[k] = value;
    support_point_[k] = point;
  }
}

void Outline::add(const Outline& other) {
  for (std::size_t k = 0; k < kDirections; ++k) {
    if (other.support_value_[k] <= support_value_[k]) continue;
    support_value_[k] = other.support_value_[k];
    support_point_[k] = other.support_point_[k];
  }
}

std::vector<Vec3> Outline::points() const {
  std::vector<Vec3> points;
  for (std::size_t k = 0; k < kDirections; ++k) {
    if (std::isinf(support_value_[k])) continue;
    if (std::ranges::find(points, support_point_[k]) == points.end())
      points.push_back(support_point_[k]);
  }
  return points;
}

ConvexCell ConvexCell::around(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  ConvexCell cell{&mesh, {}};
  for (int axis = 0; axis < 3; ++axis) {
    cell.planes.push_back({Vec3::Unit(axis), box.max()[axis]});
    cell.planes.push_back({-Vec3::Unit(axis), -box.min()[axis]});
  }
  return cell;
}

// Planes that the new one makes redundant are removed. Cuts across one axis are many, and the
// number of possible vertices grows with the third power of that of planes.
void ConvexCell::cut_by(const HalfSpace& plane) {
  const auto is_redundant = [&](const HalfSpace& other) {
    return other.normal == plane.normal && other.offset >= plane.offset;
  };
  const auto first = planes.begin() + static_cast<std::ptrdiff_t>(kBoxPlanes);
  planes.erase(std::remove_if(first, planes.end(), is_redundant), planes.end());
  planes.push_back(plane);
}

// A vertex is an intersection of three planes that no other plane cuts off.
std::vector<Vec3> ConvexCell::corners_within(const OpenSpace& space, double margin) const {
  std::vector<Vec3> corners;
  const double slack = 1e-6 * space.spacing();
  for (std::size_t i = 0; i < planes.size(); ++i) {
    for (std::size_t j = i + 1; j < planes.size(); ++j) {
      const Vec3 line = planes[i].normal.cross(planes[j].normal);
      if (line.norm() < 1e-6) continue;
      for (std::size_t k = std::max(j + 1, kBoxPlanes); k < planes.size(); ++k) {
        Mat3 normals;
        normals << planes[i].normal.transpose(), planes[j].normal.transpose(),
            planes[k].normal.transpose();
        if (std::abs(normals.determinant()) < 1e-6) continue;
        const Vec3 corner =
            normals.inverse() *
            (Vec3(planes[i].offset, planes[j].offset, planes[k].offset) + Vec3::Constant(margin));
        if (holds(planes, corner, margin + slack) && space.encloses(corner))
          corners.push_back(corner);
      }
    }
  }
  return corners;
}

void Piece::finish(std::span<const OpenPoint> open_before, double spacing) {
  outline = Outline();
  for (const Vec3& point : points) outline.add(point);
  hull = rough_hull(outline.points());
  open.clear();
  error = 0.0;
  if (hull.empty()) return;
  for (const OpenPoint& point : open_before) {
    if (!holds(hull, point.position, 0.5 * spacing)) continue;
    open.push_back(point);
    error = std::max(error, point.distance - 0.5 * spacing);
  }
}

// Clips plane by plane (I. Sutherland and G. Hodgman, 1974). Most triangles are outside one plane.
std::vector<Vec3> clipped(const Triangle& triangle, const ConvexCell& cell, double margin) {
  for (const HalfSpace& plane : cell.planes) {
    const double limit = plane.offset + margin;
    if (std::ranges::all_of(triangle, [&](const Vec3& v) { return plane.normal.dot(v) > limit; })) {
      return {};
    }
  }
  std::vector<Vec3> polygon(triangle.begin(), triangle.end()), kept;
  for (const HalfSpace& plane : cell.planes) {
    const double limit = plane.offset + margin;
    kept.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3& from = polygon[i];
      const Vec3& to = polygon[(i + 1) % polygon.size()];
      const double above_from = plane.normal.dot(from) - limit;
      const double above_to = plane.normal.dot(to) - limit;
      if (above_from <= 0.0) kept.push_back(from);
      if ((above_from < 0.0 && above_to > 0.0) || (above_from > 0.0 && above_to < 0.0)) {
        kept.push_back(from + above_from / (above_from - above_to) * (to - from));
      }
    }
    polygon.swap(kept);
    if (polygon.empty()) break;
  }
  return polygon;
}

}  // namespace clearance
