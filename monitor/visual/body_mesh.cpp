#include "monitor/visual/body_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <variant>

#include "core/shapes.hpp"
#include "monitor/visual/curved_mesh.hpp"
#include "monitor/visual/mesh_builder.hpp"

namespace clearance {
namespace {

// Edges whose facets meet at a smaller angle than this, rad, are not drawn as lines, because hulls
// of meshes have many of them.
constexpr double kSharpEdge = 0.35;

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The unit vector at the share t, 0 to 1, of the arc from a to b.
Vec3 along_arc(const Vec3& a, const Vec3& b, double t) {
  const double angle = angle_between(a, b);
  if (angle < 1e-9) return a;
  return ((a * std::sin((1.0 - t) * angle) + b * std::sin(t * angle)) / std::sin(angle))
      .normalized();
}

// A capsule, or a sphere if start == end: rings of latitude around the axis.
BodyMesh capsule_mesh(const Vec3& start, const Vec3& end, double radius, double arc_step) {
  const Vec3 axis = start == end ? Vec3(Vec3::UnitZ()) : Vec3((end - start).normalized());
  const Vec3 across = axis.unitOrthogonal(), third = axis.cross(across);
  MeshBuilder builder(arc_step);
  const int around = builder.arc_steps(2.0 * std::numbers::pi),
            quarter = builder.arc_steps(std::numbers::pi / 2.0);
  const auto ring = [&](const Vec3& centre, double latitude) {
    std::vector<std::uint32_t> row;
    for (int i = 0; i <= around; ++i) {
      const double longitude = 2.0 * std::numbers::pi * (i % around) / around;
      const Vec3 normal =
          std::sin(latitude) * axis +
          std::cos(latitude) * (std::cos(longitude) * across + std::sin(longitude) * third);
      row.push_back(builder.add(centre + radius * normal, normal));
    }
    return row;
  };
  std::vector<std::uint32_t> below;
  for (int i = -quarter; i <= quarter; ++i) {
    std::vector<std::uint32_t> row =
        ring(i <= 0 ? start : end, 0.5 * std::numbers::pi * i / quarter);
    if (!below.empty()) builder.strip(below, row);
    below = std::move(row);
    if (i != 0 || start == end) continue;
    row = ring(end, 0.0);
    builder.strip(below, row);
    below = std::move(row);
  }
  return std::move(builder.mesh);
}

// The vertices of a bounded facet, counter-clockwise from outside.
std::vector<std::int32_t> corners(const ConvexBody& body, const Facet& facet) {
  std::vector<std::int32_t> found;
  for (std::int32_t i = 0; i < facet.sides; ++i) {
    const EdgeUse& use = body.facet_edges[static_cast<std::size_t>(facet.first_side + i)];
    // The facet is to the left of its edge on side 0: its boundary passes the edge from start to
    // end.
    found.push_back(body.edges[static_cast<std::size_t>(use.edge)].vertex[use.side]);
  }
  return found;
}

const Vec3& position_of(const ConvexBody& body, std::int32_t vertex) {
  return body.vertices[static_cast<std::size_t>(vertex)].position;
}

const Vec3& normal_of(const ConvexBody& body, std::int32_t facet) {
  return body.facets[static_cast<std::size_t>(facet)].normal;
}

void add_facets(const ConvexBody& body, double radius, MeshBuilder& builder) {
  for (const Facet& facet : body.facets) {
    std::vector<std::uint32_t> loop;
    for (const std::int32_t vertex : corners(body, facet)) {
      loop.push_back(builder.add(position_of(body, vertex) + radius * facet.normal, facet.normal));
    }
    for (std::size_t i = 2; i < loop.size(); ++i) builder.triangle(loop[0], loop[i - 1], loop[i]);
  }
}

// The cylinder strip along an edge, from the normal of its left facet to that of its right one.
void add_edge_strip(const ConvexBody& body, const Edge& edge, double radius, MeshBuilder& builder) {
  const Vec3& left = normal_of(body, edge.facet[0]);
  const Vec3& right = normal_of(body, edge.facet[1]);
  const int steps = builder.arc_steps(angle_between(left, right));
  std::vector<std::uint32_t> at_start, at_end;
  for (int i = 0; i <= steps; ++i) {
    const Vec3 normal = along_arc(left, right, static_cast<double>(i) / steps);
    at_start.push_back(builder.add(position_of(body, edge.vertex[0]) + radius * normal, normal));
    at_end.push_back(builder.add(position_of(body, edge.vertex[1]) + radius * normal, normal));
  }
  builder.strip(at_start, at_end);
}

// One sector of the sphere patch at a vertex: from its middle to the arc from a to b.
void add_sector(const Vec3& centre, double radius, const Vec3& middle, const Vec3& a, const Vec3& b,
                MeshBuilder& builder) {
  const int steps = builder.arc_steps(angle_between(a, b));
  const int rows = builder.arc_steps(std::max(angle_between(middle, a), angle_between(middle, b)));
  std::vector<std::uint32_t> inner;
  for (int j = 0; j <= rows; ++j) {
    std::vector<std::uint32_t> row;
    for (int i = 0; i <= steps; ++i) {
      const Vec3 rim = along_arc(a, b, static_cast<double>(i) / steps);
      const Vec3 normal = along_arc(middle, rim, static_cast<double>(j) / rows);
      row.push_back(builder.add(centre + radius * normal, normal));
    }
    if (!inner.empty()) builder.strip(row, inner);
    inner = std::move(row);
  }
}

void add_vertex_patch(const ConvexBody& body, const Vertex& vertex, double radius,
                      MeshBuilder& builder) {
  std::vector<Vec3> normals;  // normals of the facets around it, counter-clockwise
  Vec3 middle = Vec3::Zero();
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const EdgeUse& use = body.vertex_edges[static_cast<std::size_t>(vertex.first_edge + i)];
    const Edge& edge = body.edges[static_cast<std::size_t>(use.edge)];
    normals.push_back(normal_of(body, edge.facet[use.side]));
    middle += normals.back();
  }
  middle.normalize();
  for (std::size_t i = 0; i < normals.size(); ++i) {
    add_sector(vertex.position, radius, middle, normals[i], normals[(i + 1) % normals.size()],
               builder);
  }
}

void add_sharp_edges(const ConvexBody& body, MeshBuilder& builder) {
  for (const Edge& edge : body.edges) {
    if (angle_between(normal_of(body, edge.facet[0]), normal_of(body, edge.facet[1])) < kSharpEdge)
      continue;
    builder.mesh.edges.push_back(
        {position_of(body, edge.vertex[0]), position_of(body, edge.vertex[1])});
  }
}

BodyMesh bounded_mesh(const ConvexBody& body, double radius, double arc_step) {
  if (body.facets.empty()) {
    return capsule_mesh(body.anchors.front(), body.anchors.back(), radius, arc_step);
  }
  MeshBuilder builder(arc_step);
  add_facets(body, radius, builder);
  if (radius > 0.0) {
    for (const Edge& edge : body.edges) add_edge_strip(body, edge, radius, builder);
    for (const Vertex& vertex : body.vertices) add_vertex_patch(body, vertex, radius, builder);
  } else {
    add_sharp_edges(body, builder);
  }
  return std::move(builder.mesh);
}

// The part of an unbounded body in the cube of half width `reach`.
ShapeResult cut_off(const ConvexBody& body, double reach) {
  std::vector<HalfSpace> rows;
  for (const Facet& facet : body.facets) rows.push_back({facet.normal, facet.offset});
  for (int axis = 0; axis < 3; ++axis) {
    rows.push_back({Vec3::Unit(axis), reach});
    rows.push_back({-Vec3::Unit(axis), reach});
  }
  return polyhedron_from_halfspaces(rows);
}

}  // namespace

BodyMesh body_mesh(const ConvexBody& body, double offset, double reach, double arc_step) {
  if (body.is_curved()) return curved_mesh(body.curved, body.radius + offset, arc_step);
  if (body.bounded()) return bounded_mesh(body, body.radius + offset, arc_step);
  const ShapeResult cut = cut_off(body, reach);
  const auto* const bounded = std::get_if<ConvexBody>(&cut);
  return bounded == nullptr ? BodyMesh{} : bounded_mesh(*bounded, body.radius + offset, arc_step);
}

}  // namespace clearance
