// Factories of curved bodies. Nothing is rounded: the doubles given define the body.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/numerics/error_constants.hpp"
#include "core/query_tables.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

bool is_extent(double length) noexcept {
  return length >= 0.5 * kLeastExtent && length <= kLargestCoordinate;
}
bool is_radius(double length) noexcept { return length >= 0.0 && length <= kLargestCoordinate; }

ShapeError bad_extent(const char* what) {
  return {std::string(what) + " is not a length from 1e-12 to 1e12 m"};
}
ShapeError bad_radius(const char* what) {
  return {std::string(what) + " is not a length from 0 to 1e12 m"};
}

// bounding_radius: the bounding radius of the shape without the radius around it, m.
ShapeResult body_of(const CurvedShape& shape, double bounding_radius, double rounding) {
  ConvexBody body;
  body.curved = shape;
  body.bounding_radius = bounding_radius;
  add_query_tables(body);
  return rounded_by(rounding, std::move(body));
}

}  // namespace

ShapeResult ellipsoid(const Vec3& semi_axes, double rounding) {
  for (const double axis : semi_axes) {
    if (!is_extent(axis)) return bad_extent("a semi-axis");
  }
  CurvedShape shape;
  shape.kind = CurvedShape::Kind::kEllipsoid;
  shape.semi_axes = semi_axes;
  return body_of(shape, semi_axes.maxCoeff(), rounding);
}

ShapeResult truncated_cone(double lower_radius, double upper_radius, double half_length,
                           double rounding) {
  if (!is_extent(half_length)) return bad_extent("half the length");
  const auto [narrow, wide] = std::minmax(lower_radius, upper_radius);
  if (!is_extent(wide)) return bad_extent("the radius of the larger end");
  if (!is_radius(narrow)) return bad_radius("the radius of the smaller end");
  CurvedShape shape;
  shape.kind = CurvedShape::Kind::kTruncatedCone;
  shape.discs = {Disc{-half_length, lower_radius}, Disc{half_length, upper_radius}};
  return body_of(shape, std::hypot(half_length, wide) * kRoundedUp, rounding);
}

ShapeResult cylinder(double radius, double half_length, double rounding) {
  return truncated_cone(radius, radius, half_length, rounding);
}

ShapeResult cone(double base_radius, double half_length, double rounding) {
  return truncated_cone(base_radius, 0.0, half_length, rounding);
}

ShapeResult rounded_by(double radius, ConvexBody body) {
  if (!is_radius(radius)) return bad_radius("the radius around it");
  body.radius = radius;
  return body;
}

}  // namespace clearance
