#include "monitor/pairs/contact_cone.hpp"

#include <algorithm>
#include <cmath>

#include "core/model/support_function.hpp"
#include "monitor/bodies/fixed_order.hpp"

namespace clearance {
namespace {

// A witness point nearer than this to a vertex or an edge is on it, m.
constexpr double kOnFeature = 1e-9;

Vec3 transposed_times(const Mat3& m, const Vec3& v) noexcept {
  return {(m(0, 0) * v.x() + m(1, 0) * v.y()) + m(2, 0) * v.z(),
          (m(0, 1) * v.x() + m(1, 1) * v.y()) + m(2, 1) * v.z(),
          (m(0, 2) * v.x() + m(1, 2) * v.y()) + m(2, 2) * v.z()};
}

bool is_on_line(const Vec3& from_vertex, const Vec3& along) noexcept {
  const Vec3 off = from_vertex - dot(from_vertex, along) * along;
  return dot(off, off) <= kOnFeature * kOnFeature;
}

// The distance of a unit vector from the line along another one.
double off_line(const Vec3& v, const Vec3& along) noexcept {
  const Vec3 off = cross(v, along);
  return std::min(1.0, std::sqrt(dot(off, off)));
}

}  // namespace

ContactCone::ContactCone(const PosedPart& part, const Vec3& witness, const Vec3& outward) noexcept
    : body_(*part.shape), world_from_part_(part.world_from_part_rotation) {
  if (body_.is_curved()) return;
  const Vec3 m = in_part(outward);
  find(in_part(witness - part.world_from_part.position) - body_.radius * m, m);
}

// The support point is a vertex of the face, edge or vertex that holds the witness point.
void ContactCone::find(const Vec3& point, const Vec3& outward) noexcept {
  if (body_.vertices.empty()) {
    if (body_.is_half_space()) kind_ = Kind::kFace;
    return;
  }
  vertex_ = support(body_, outward).anchor;
  const Vertex& vertex = body_.vertices[static_cast<std::size_t>(vertex_)];
  const bool has_faces = !body_.facets.empty();
  const Vec3 from_vertex = point - vertex.position;
  if (vertex.edges == 0) {
    kind_ = Kind::kPoint;
  } else if (dot(from_vertex, from_vertex) <= kOnFeature * kOnFeature) {
    kind_ = has_faces ? Kind::kVertex : Kind::kSegmentEnd;
  } else {
    kind_ = Kind::kFace;
    for (std::int32_t i = 0; i < vertex.edges; ++i) {
      if (!is_on_line(from_vertex, body_.outgoing_of(vertex, i))) continue;
      kind_ = has_faces ? Kind::kEdge : Kind::kSegment;
      edge_ = body_.vertex_edges[static_cast<std::size_t>(vertex.first_edge + i)].edge;
    }
  }
}

Vec3 ContactCone::in_part(const Vec3& v) const noexcept {
  return transposed_times(world_from_part_, v);
}

int ContactCone::edges() const noexcept {
  switch (kind_) {
    case Kind::kUnknown:
    case Kind::kPoint:
    case Kind::kFace:
      return 0;
    case Kind::kSegmentEnd:
      return 1;
    case Kind::kSegment:
      return 2;
    case Kind::kEdge:
      return 4;
    case Kind::kVertex:
      break;
  }
  return body_.vertices[static_cast<std::size_t>(vertex_)].edges;
}

Vec3 ContactCone::edge(int i) const noexcept {
  if (edge_ != kNone) {
    const Edge& edge = body_.edges[static_cast<std::size_t>(edge_)];
    if (i >= 2) return times(world_from_part_, edge.inward.row(i - 2).transpose());
    const Vec3 along = times(world_from_part_, edge.direction);
    return i == 0 ? along : Vec3(-along);
  }
  const Vertex& vertex = body_.vertices[static_cast<std::size_t>(vertex_)];
  return times(world_from_part_, body_.outgoing_of(vertex, i));
}

double ContactCone::leaves(const Vec3& tangent) const noexcept {
  if (kind_ == Kind::kFace) return 0.0;
  const Vec3 t = in_part(tangent);
  if (kind_ == Kind::kSegment)
    return off_line(t, body_.edges[static_cast<std::size_t>(edge_)].direction);
  const auto past_face = [&](std::int32_t facet) {
    return dot(body_.facets[static_cast<std::size_t>(facet)].normal, t);
  };
  if (kind_ == Kind::kEdge) {
    const Edge& edge = body_.edges[static_cast<std::size_t>(edge_)];
    return std::max({0.0, past_face(edge.facet[0]), past_face(edge.facet[1])});
  }
  const Vertex& vertex = body_.vertices[static_cast<std::size_t>(vertex_)];
  if (kind_ == Kind::kSegmentEnd) {
    const Vec3 along = body_.outgoing_of(vertex, 0);
    return dot(t, along) > 0.0 ? off_line(t, along) : 1.0;
  }
  double sine = 0.0;
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const EdgeUse& use = body_.vertex_edges[static_cast<std::size_t>(vertex.first_edge + i)];
    sine =
        std::max(sine, past_face(body_.edges[static_cast<std::size_t>(use.edge)].facet[use.side]));
  }
  return sine;
}

}  // namespace clearance
