// A convex body in the form that queries read. It is a polyhedron with facets, edges, vertices and
// their adjacency, or a curved shape, which has none of these. Either has an optional radius around
// it.
//
// The polyhedron is an intersection of half-spaces n.x <= d (outward unit normals). It may be
// unbounded: a floor is one half-space. Only two lower-dimensional shapes are allowed: a point and
// a segment, which with a radius are a sphere and a capsule. The checked factories of
// core/shapes.hpp make it by exact arithmetic. Every number here is the exact one rounded once, so
// that queries can run in doubles.
//
// Invariants: Every edge has relative-interior points. The edges of every vertex generate its cone.
// The edges of every facet bound it in counter-clockwise order as seen from outside; they are an
// open chain when the facet is unbounded. No two facets are coplanar and no vertex lies within a
// facet or an edge, exactly.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/curved_shape.hpp"
#include "core/query_tables.hpp"
#include "core/vec.hpp"

namespace clearance {

inline constexpr std::int32_t kNone = -1;  // no feature
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One half-space n.x <= d of the model whose bounding plane touches it in a facet.
struct Facet {
  Vec3 normal;    // outward, unit
  double offset;  // d, m
  // The boundary is facet_edges[first_side, first_side + sides); a half-space's plane has none. The
  // range goes on up to first_side + limits, where sides that end at a sharp vertex are repeated.
  // first_side is a multiple of four, as VectorRows needs it.
  std::int32_t first_side;
  std::int32_t sides;
  std::int32_t limits;
  std::int32_t anchor;  // one of the facet's points (of a half-space's plane, any)
};

// A straight edge x = point + s * direction, s in [0, length]; open-ended ones run to infinity.
struct Edge {
  Vec3 point;  // where the edge starts (s = 0): its first vertex; on a full line, any point of it
  Vec3 direction;  // unit
  // Row k: unit, in the plane of facet[k], across the edge into that facet; zero for a segment.
  // Stored by columns, because vector registers read both rows at once.
  alignas(16) Eigen::Matrix<double, 2, 3> inward;
  double begin;            // 0, or -infinity for a full line (the only edge without a first vertex)
  double end;              // length, m; infinity for a ray or a full line
  std::int32_t vertex[2];  // start, end; kNone where the edge does not end
  // The two facets that meet here; kNone for a segment's only edge. facet[0] lies to the left of
  // the direction as seen from outside, facet[1] to the right.
  std::int32_t facet[2];
};

// An edge as listed by one of its facets or vertices.
struct EdgeUse {
  std::int32_t edge;
  std::int32_t side;  // facets: the k of Edge::facet[k]; vertices: the k of Edge::vertex[k]
};

struct Vertex {
  Vec3 position;
  // vertex_edges[first_edge, first_edge + edges): the edges that leave it, counter-clockwise as
  // seen from outside; none for a single point. first_edge is a multiple of four.
  std::int32_t first_edge;
  std::int32_t edges;
};

// A direction in which the body is unbounded.
struct Ray {
  Vec3 direction;  // unit, unless exact
  bool exact;  // then `direction` is the exact direction up to a positive factor, not a rounded one
  bool is_line = false;  // its opposite, exactly, is one as well
};

struct ConvexBody {
  std::vector<Facet> facets;
  std::vector<Edge> edges;
  std::vector<Vertex> vertices;
  std::vector<EdgeUse> facet_edges;
  std::vector<EdgeUse> vertex_edges;

  // The body is hull(anchors) + cone(rays). `anchors` are the vertices if there are any, else one
  // point of each minimal face (of a line or a plane). A line counts as two opposite rays.
  std::vector<Vec3> anchors;
  std::vector<Ray> rays;
  RecessionCone recession_cone;  // of an unbounded body; made by add_query_tables()

  // The same numbers again, in the order in which queries read them; made by add_query_tables().
  VectorRows<3> outgoing;      // a row a vertex: unit, along vertex_edges[i], away from the vertex
  VectorRows<4> facet_limits;  // a row a facet: of facet_edges[i]
  PlaneTable planes;
  // The vertices at the far ends of `vertex_edges`, kNone where such an edge does not end; and the
  // facets on the far sides of `facet_edges`.
  std::vector<std::int32_t> neighbours, facets_beside;
  std::array<std::uint32_t, 3> features{};  // how many vertices, edges, facets
  StartTable start;
  BoxFeatures box;

  // A point far inside the body (for a point or segment, in its relative interior).
  Vec3 interior = Vec3::Zero();
  // The sphere of this radius around `interior` lies inside, rounding included, m; 0: not known.
  // Made by add_query_tables().
  double inner_radius = 0.0;
  double bounding_radius =
      0.0;  // largest |point| without the radius from the frame's origin, rounded up, m
  // Every anchor, offset and edge end is within this of the exact one, m; every unit vector is
  // within 2^-52.
  double position_error = 0.0;
  // The part of a query's error bound that does not depend on the pose, m: for the body as A, and
  // as B. For an unbounded body it excludes the part that grows with the place of the closest
  // points. Made by add_query_tables().
  double error_bound_as_a = 0.0, error_bound_as_b = 0.0;
  // The body is the polyhedron or curved shape plus a sphere of this radius, m (exact); 0 to
  // kLargestCoordinate.
  double radius = 0.0;

  // Set for a curved body. Such a body has only the interior point, the radii and the bounds among
  // the members above.
  CurvedShape curved;

  [[nodiscard]] bool is_curved() const noexcept { return curved.kind != CurvedShape::Kind::kNone; }
  [[nodiscard]] bool bounded() const noexcept { return rays.empty(); }
  [[nodiscard]] bool is_half_space() const noexcept { return facets.size() == 1; }
  // Is it a point or a segment: a sphere or a capsule without its radius?
  [[nodiscard]] bool is_thin() const noexcept { return features[2] == 0 && features[0] != 0; }

  // Unit, away from the vertex, along the i-th of its edges.
  [[nodiscard]] Vec3 outgoing_of(const Vertex& v, std::int32_t i) const noexcept {
    const auto number = [&](std::int32_t k) { return outgoing.number(v.first_edge, i, k); };
    return {number(0), number(1), number(2)};
  }
  void set_outgoing(const Vertex& v, std::int32_t i, const Vec3& to) noexcept {
    for (std::int32_t k = 0; k < 3; ++k) outgoing.set(v.first_edge, v.edges, i, k, to[k]);
  }
  // One of the facet's points, or of its plane.
  [[nodiscard]] const Vec3& point_of(const Facet& f) const noexcept {
    return anchors[static_cast<std::size_t>(f.anchor)];
  }
  // The i-th limit of the facet.
  [[nodiscard]] FacetLimit limit_of(const Facet& f, std::int32_t i) const noexcept {
    const auto number = [&](std::int32_t k) { return facet_limits.number(f.first_side, i, k); };
    return {{number(0), number(1), number(2)}, number(3)};
  }
  void set_limit(const Facet& f, std::int32_t i, const FacetLimit& to) noexcept {
    for (std::int32_t k = 0; k < 3; ++k) {
      facet_limits.set(f.first_side, f.limits, i, k, to.inward[k]);
    }
    facet_limits.set(f.first_side, f.limits, i, 3, to.offset);
  }
};
static_assert(sizeof(std::vector<Facet>) == 3 * sizeof(void*),
              "compiled with _GLIBCXX_DEBUG: the library has the containers without it");
static_assert(sizeof(Facet) == 48 && sizeof(Edge) == 128 && alignof(Edge) == 16);
static_assert(sizeof(Vertex) == 32 && sizeof(Ray) == 32 && sizeof(RecessionCone) == 112);
static_assert(sizeof(ConvexBody) == 2216 && alignof(ConvexBody) == 8);

}  // namespace clearance
