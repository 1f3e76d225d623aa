#include "monitor/clouds/slab_body.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "core/gjk/simplex.hpp"
#include "core/numerics/double_double.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/shapes.hpp"

namespace clearance {
namespace {

using Wide = Vector<DoubleDouble>;

// v / |v|, off by at most two roundings in each component. The reciprocal length is corrected by
// one step of Newton's method whose residual is in double-double.
Vec3 unit(const Wide& v) noexcept {
  const DoubleDouble squared = dot(v, v);
  const double inverse = 1.0 / std::sqrt(squared.high);
  const DoubleDouble residual = DoubleDouble(1.0) - squared * exact::product(inverse, inverse);
  const double correction = 0.5 * residual.high;
  const auto component = [&](const DoubleDouble& x) {
    const DoubleDouble p = exact::product(x.high, inverse);
    return p.high + (p.low + (p.high * correction + x.low * inverse));
  };
  return {component(v.x), component(v.y), component(v.z)};
}

// The outward normal of a side: of a plane z = constant, or of one through the origin.
Vec3 normal_of(int axis, bool upper, const DepthCloud::Slab& s) noexcept {
  const double sign = upper ? 1.0 : -1.0;
  if (axis == 2) return {0.0, 0.0, sign};
  const double edge = axis == 0 ? (upper ? s.x1 : s.x0) : (upper ? s.y1 : s.y0);
  return unit(axis == 0 ? Wide{sign, 0.0, -sign * edge} : Wide{0.0, sign, -sign * edge});
}

// In the side plane through the ray (x, y, 1) and the axis of y, for `axis` 0, or of x: at right
// angles to the ray, towards positive y, or x. The vector product of the plane's normal and the
// ray.
Vec3 across_ray(int axis, double x, double y) noexcept {
  const DoubleDouble xy = exact::product(x, y);
  if (axis == 0) return unit({-xy, DoubleDouble(1.0) + exact::product(x, x), -y});
  return unit({DoubleDouble(1.0) + exact::product(y, y), -xy, -x});
}

}  // namespace

SlabBody::SlabBody()
    : origin_(std::get<ConvexBody>(point(Vec3::Zero(), 0.0))),
      body_(std::get<ConvexBody>(box({1.0, 1.0, 1.0}))) {
  body_.box = {};  // slabs have its features, but are no boxes
  for (std::size_t f = 0; f < sides_.size(); ++f) {
    for (int axis = 0; axis < 3; ++axis) {
      const double n = body_.facets[f].normal[axis];
      if (n != 0.0) sides_[f] = {axis, n > 0.0};
    }
  }
  for (std::size_t v = 0; v < corners_.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      corners_[v] |= static_cast<unsigned>(body_.anchors[v][axis] > 0.0) << axis;
    }
  }
}

const ConvexBody& SlabBody::of(const DepthCloud::Slab& s) noexcept {
  for (std::size_t f = 0; f < sides_.size(); ++f) {
    const Side& side = sides_[f];
    body_.facets[f].normal = normal_of(side.axis, side.upper, s);
    body_.facets[f].offset = side.axis == 2 ? (side.upper ? s.high : -s.low) : 0.0;  // exact
  }
  double farthest = 0.0;
  for (std::size_t v = 0; v < corners_.size(); ++v) {
    const Corner at = corner(corners_[v], s);
    body_.anchors[v] = body_.vertices[v].position = {at.x * at.z, at.y * at.z, at.z};
    farthest = std::max(farthest, body_.anchors[v].norm());
  }
  double longest = 0.0;
  for (Edge& edge : body_.edges) {
    set_edge(s, edge);
    longest = std::max(longest, edge.end);
  }
  body_.interior = s.middle();
  body_.bounding_radius = farthest * (1.0 + 0x1p-50);
  // Each coordinate is rounded once. A length has at most six roundings of its own size.
  body_.position_error = kUlp * std::max(2.0 * body_.bounding_radius, 6.0 * longest);
  fill_tables();
  return body_;
}

SlabBody::Corner SlabBody::corner(unsigned bits, const DepthCloud::Slab& s) noexcept {
  return {(bits & 1U) != 0 ? s.x1 : s.x0, (bits & 2U) != 0 ? s.y1 : s.y0,
          (bits & 4U) != 0 ? s.high : s.low};
}

// An edge leads along x, along y, or along a ray. At right angles to it in each of its facets: a
// vector product with a unit vector of the frame is exact.
void SlabBody::set_edge(const DepthCloud::Slab& s, Edge& edge) noexcept {
  const unsigned from = corners_[static_cast<std::size_t>(edge.vertex[0])];
  const unsigned to = corners_[static_cast<std::size_t>(edge.vertex[1])];
  const unsigned along = from ^ to;  // one bit
  const double sign = (to & along) != 0 ? 1.0 : -1.0;
  const Corner at = corner(from, s);
  edge.point = body_.anchors[static_cast<std::size_t>(edge.vertex[0])];
  if (along != 4U) {
    const bool is_x = along == 1U;
    edge.direction = is_x ? Vec3(sign, 0.0, 0.0) : Vec3(0.0, sign, 0.0);
    edge.end = at.z * (is_x ? s.x1 - s.x0 : s.y1 - s.y0);
    const Vec3& left = body_.facets[static_cast<std::size_t>(edge.facet[0])].normal;
    const Vec3& right = body_.facets[static_cast<std::size_t>(edge.facet[1])].normal;
    edge.inward.row(0) = left.cross(edge.direction).transpose();
    edge.inward.row(1) = edge.direction.cross(right).transpose();
    return;
  }
  edge.direction = sign * unit({at.x, at.y, 1.0});
  edge.end = (s.high - s.low) * std::sqrt(1.0 + at.x * at.x + at.y * at.y);
  for (int k = 0; k < 2; ++k) {
    // A facet across x extends from this edge along y, to the other end of the slab.
    const int axis = sides_[static_cast<std::size_t>(edge.facet[k])].axis;
    const bool at_upper_end = (from & (axis == 0 ? 2U : 1U)) != 0;
    edge.inward.row(k) = ((at_upper_end ? -1.0 : 1.0) * across_ray(axis, at.x, at.y)).transpose();
  }
}

// Does the work of add_query_tables() without allocating. Bodies of eight vertices need no table of
// starts: they are scanned.
void SlabBody::fill_tables() noexcept {
  body_.error_bound_as_a =
      kUlp * kUlpsOnA * body_.bounding_radius + (body_.position_error + kUnderflow);
  body_.error_bound_as_b = kUlp * kUlpsOnB * body_.bounding_radius + body_.position_error;
  body_.inner_radius = 0.0;  // not known
  for (const Vertex& vertex : body_.vertices) {
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      const EdgeUse& use = body_.vertex_edges[static_cast<std::size_t>(vertex.first_edge + i)];
      const Vec3& along = body_.edges[static_cast<std::size_t>(use.edge)].direction;
      body_.set_outgoing(vertex, i, use.side == 0 ? along : Vec3(-along));
    }
  }
  for (const Facet& facet : body_.facets) {
    for (std::int32_t i = 0; i < facet.limits; ++i) {
      const EdgeUse& use = body_.facet_edges[static_cast<std::size_t>(facet.first_side + i)];
      const Edge& edge = body_.edges[static_cast<std::size_t>(use.edge)];
      const Vec3 inward = edge.inward.row(use.side);
      body_.set_limit(facet, i, {inward, inward.dot(edge.point)});
    }
  }
  const auto facets = static_cast<std::int32_t>(body_.facets.size());
  for (std::int32_t f = 0; f < facets; ++f) {
    const Facet& facet = body_.facets[static_cast<std::size_t>(f)];
    for (std::int32_t k = 0; k < 3; ++k) body_.planes.set(facets, f, k, facet.normal[k]);
    body_.planes.set(facets, f, 3, facet.offset);
  }
}

}  // namespace clearance
