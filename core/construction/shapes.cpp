#include "core/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/construction/exact_polyhedron.hpp"
#include "core/construction/rounded_once.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/query_tables.hpp"

namespace clearance {
namespace {

ShapeResult rounded(const std::variant<exact::Solid, ShapeError>& made) {
  if (const ShapeError* error = std::get_if<ShapeError>(&made)) return *error;
  return exact::rounded_polyhedron(std::get<exact::Solid>(made));
}

ShapeError bad_row(std::size_t row, const std::string& what) {
  return {"row " + std::to_string(row + 1) + " " + what};
}

// Nothing when the radius can be used.
std::string radius_fault(double radius) {
  if (!std::isfinite(radius) || !(radius >= 0.0)) {
    return "the radius is not a finite number of at least 0";
  }
  return radius <= kLargestCoordinate ? "" : "the radius is more than 1e12 m";
}

bool is_too_far(const Vec3& point) { return !(point.cwiseAbs().maxCoeff() <= kLargestCoordinate); }

// Nothing when the row can be used.
std::string row_fault(const HalfSpace& row) {
  if (!row.normal.allFinite() || !std::isfinite(row.offset)) {
    return "has a number that is not finite";
  }
  const double length = row.normal.stableNorm();
  if (length == 0.0) return "has a zero normal: it bounds nothing";
  if (!(length >= kShortestNormal && length <= kLongestNormal)) {
    return "has a normal whose length is not from 1e-100 to 1e100";
  }
  // A quotient that overflows is too far as well.
  const bool near = std::abs(row.offset / length) <= kLargestCoordinate;
  return near ? "" : "is a plane more than 1e12 m from the origin";
}

// Nothing when the point can be used.
std::string point_fault(const Vec3& point) {
  if (!point.allFinite()) return " has a coordinate that is not finite";
  return is_too_far(point) ? " lies more than 1e12 m from the origin" : "";
}

struct SegmentLine {
  Vec3 direction;
  exact::Rounded length;
};

// The exact line between two points; its direction and its length are each rounded once. With
// weights w of the homogeneous points, the length is |d| / w = |d|^2 / sqrt(|d|^2 w^2).
SegmentLine line_from(const Vec3& start, const Vec3& end) {
  const exact::Integer4 a = exact::integer_multiple({start.x(), start.y(), start.z(), 1.0});
  const exact::Integer4 b = exact::integer_multiple({end.x(), end.y(), end.z(), 1.0});
  exact::Integer3 difference;
  for (std::size_t i = 0; i < 3; ++i) difference[i] = b[i] * a[3] - a[i] * b[3];
  const exact::Integer squared = exact::dot(difference, difference);
  const exact::Integer weight = a[3] * b[3];
  return {exact::unit(difference), exact::nearest_over_root(squared, squared * weight * weight)};
}

}  // namespace

ShapeResult polyhedron_from_halfspaces(std::span<const HalfSpace> rows) {
  if (rows.empty()) return ShapeError{"no half-spaces: at least one is needed"};
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (const std::string fault = row_fault(rows[row]); !fault.empty()) return bad_row(row, fault);
  }
  return rounded(exact::intersection_of(rows));
}

ShapeResult polyhedron_from_vertices(std::span<const Vec3> points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (const std::string fault = point_fault(points[i]); !fault.empty()) {
      return ShapeError{"point " + std::to_string(i + 1) + fault};
    }
  }
  if (points.size() < 4) {
    return ShapeError{"a solid needs at least four points, found " + std::to_string(points.size())};
  }
  return rounded(exact::hull_of(points));
}

ShapeResult box(const Vec3& half_extents) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::isfinite(half_extents[axis]) && half_extents[axis] > 0.0) continue;
    return ShapeError{std::string("half extent ") + "xyz"[axis] +
                      " is not a finite number above 0"};
  }
  std::vector<Vec3> vertices;
  for (const double z : {-half_extents.z(), half_extents.z()}) {
    for (const double y : {-half_extents.y(), half_extents.y()}) {
      for (const double x : {-half_extents.x(), half_extents.x()}) vertices.emplace_back(x, y, z);
    }
  }
  return polyhedron_from_vertices(vertices);
}

ShapeResult prism(std::span<const Vec2> base, double z_low, double z_high) {
  if (!std::isfinite(z_low) || !std::isfinite(z_high) || !(z_low < z_high)) {
    return ShapeError{"the prism's low end must be finite and below its high end"};
  }
  if (base.size() < 3) {
    return ShapeError{"a prism's base needs at least three points, found " +
                      std::to_string(base.size())};
  }
  std::vector<Vec3> vertices;
  vertices.reserve(2 * base.size());
  for (const double z : {z_low, z_high}) {
    for (std::size_t i = 0; i < base.size(); ++i) {
      vertices.emplace_back(base[i].x(), base[i].y(), z);
      if (const std::string fault = point_fault(vertices.back()); !fault.empty()) {
        return ShapeError{"base point " + std::to_string(i + 1) + fault};
      }
    }
  }
  // Points inside the base and repeated ones are no fault: the hull leaves them out.
  ShapeResult made = polyhedron_from_vertices(vertices);
  if (std::holds_alternative<ShapeError>(made)) {
    return ShapeError{"the prism's base has no area, or the prism is thinner than 1e-12 m"};
  }
  return made;
}

ShapeResult point(const Vec3& position, double radius) {
  if (const std::string fault = point_fault(position); !fault.empty()) {
    return ShapeError{"the point" + fault};
  }
  if (const std::string fault = radius_fault(radius); !fault.empty()) return ShapeError{fault};
  ConvexBody body;
  body.vertices.push_back({position, 0, 0});
  body.anchors.push_back(position);
  body.interior = position;
  // Rounded up: a norm is off by 2.5 ulps.
  body.bounding_radius = position.norm() * kRoundedUp;
  body.radius = radius;
  add_query_tables(body);
  return body;
}

ShapeResult segment(const Vec3& start, const Vec3& end, double radius) {
  for (const Vec3& point : {start, end}) {
    if (const std::string fault = point_fault(point); !fault.empty()) {
      return ShapeError{"an end of the segment" + fault};
    }
  }
  if (start == end) return ShapeError{"the segment's two ends are the same point"};
  if (!((end - start).norm() >= kLeastExtent)) {
    return ShapeError{"the segment is shorter than 1e-12 m"};
  }
  if (const std::string fault = radius_fault(radius); !fault.empty()) return ShapeError{fault};
  const SegmentLine line = line_from(start, end);
  ConvexBody body;
  body.edges.push_back({start,
                        line.direction,
                        Eigen::Matrix<double, 2, 3>::Zero(),
                        0.0,
                        line.length.value,
                        {0, 1},
                        {kNone, kNone}});
  body.vertices = {{start, 0, 1}, {end, 4, 1}};
  body.vertex_edges = {{0, 0}, {0, 0}, {0, 0}, {0, 0}, {0, 1}, {0, 1}, {0, 1}, {0, 1}};
  body.anchors = {start, end};
  body.interior = 0.5 * start + 0.5 * end;
  body.bounding_radius = std::max(start.norm(), end.norm()) * kRoundedUp;
  body.position_error = line.length.exact ? 0.0 : kUlp * line.length.value;
  body.radius = radius;
  add_query_tables(body);
  return body;
}

}  // namespace clearance
