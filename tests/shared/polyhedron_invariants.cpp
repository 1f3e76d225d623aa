#include "tests/shared/polyhedron_invariants.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace clearance {
namespace {

std::size_t at(std::int32_t i) { return static_cast<std::size_t>(i); }

class Inspection {
 public:
  explicit Inspection(const ConvexBody& body) : body_(body) {}

  std::vector<std::string> run() {
    if (!indices_are_valid()) return std::move(broken_);
    check_facets();
    check_edges();
    check_facet_chains();
    check_vertices();
    check_counts();
    check_containment();
    check_summary();
    return std::move(broken_);
  }

 private:
  void expect(bool holds, const std::string& claim, std::size_t number) {
    constexpr std::size_t kEnough = 20;
    if (holds || broken_.size() >= kEnough) return;
    broken_.push_back(claim + " (number " + std::to_string(number) + ")");
  }

  // The rounding error allowed for a coordinate or a plane's offset at this point.
  double tolerance(const Vec3& near) const {
    return 4.0 * body_.position_error + 0x1p-49 * near.norm();
  }

  static bool is_unit(const Vec3& v) { return std::abs(v.norm() - 1.0) <= 0x1p-51; }
  static bool perpendicular(const Vec3& a, const Vec3& b) { return std::abs(a.dot(b)) <= 0x1p-50; }

  bool in_range(std::int32_t i, std::size_t size) const {
    return i == kNone || (i >= 0 && at(i) < size);
  }

  bool indices_are_valid() {
    std::size_t next = 0;
    for (const Facet& facet : body_.facets) {
      expect(facet.sides >= 0 && facet.limits >= facet.sides && at(facet.first_side) == next,
             "facets list their sides in order", next);
      next += at(VectorRows<4>::length(facet.limits));
      expect(in_range(facet.anchor, body_.anchors.size()) && facet.anchor != kNone,
             "a facet's point exists", at(facet.first_side));
    }
    expect(next == body_.facet_edges.size(), "facet_edges belong to facets", next);
    next = 0;
    for (const Vertex& vertex : body_.vertices) {
      expect(vertex.edges >= 0 && at(vertex.first_edge) == next,
             "vertices list their edges in order", next);
      next += at(VectorRows<3>::length(vertex.edges));
    }
    expect(next == body_.vertex_edges.size(), "vertex_edges belong to vertices", next);
    for (std::size_t e = 0; e < body_.edges.size(); ++e) {
      for (std::size_t k = 0; k < 2; ++k) {
        expect(in_range(body_.edges[e].facet[k], body_.facets.size()), "edge facets exist", e);
        expect(in_range(body_.edges[e].vertex[k], body_.vertices.size()), "edge vertices exist", e);
      }
    }
    for (const std::vector<EdgeUse>* uses : {&body_.facet_edges, &body_.vertex_edges}) {
      for (const EdgeUse& use : *uses) {
        expect(
            use.edge >= 0 && at(use.edge) < body_.edges.size() && (use.side == 0 || use.side == 1),
            "edge uses exist", at(use.edge));
      }
    }
    return broken_.empty();
  }

  void check_facets() {
    for (std::size_t f = 0; f < body_.facets.size(); ++f) {
      const Facet& facet = body_.facets[f];
      expect(is_unit(facet.normal), "facet normals are unit", f);
      const Vec3& point = body_.point_of(facet);
      expect(std::abs(facet.normal.dot(point) - facet.offset) <= tolerance(point),
             "a facet's point is in its plane", f);
    }
  }

  void check_edges() {
    for (std::size_t e = 0; e < body_.edges.size(); ++e) {
      const Edge& edge = body_.edges[e];
      expect(is_unit(edge.direction), "edge directions are unit", e);
      check_edge_ends(edge, e);
      if (edge.facet[0] == kNone || edge.facet[1] == kNone) {
        expect(edge.facet[0] == edge.facet[1] && body_.facets.empty(),
               "only a segment's edge has no facets", e);
        continue;
      }
      const Facet& left = body_.facets[at(edge.facet[0])];
      const Facet& right = body_.facets[at(edge.facet[1])];
      expect(edge.facet[0] != edge.facet[1], "an edge separates two facets", e);
      check_edge_in_facet(edge, left, left.normal.cross(edge.direction), edge.inward.row(0), e);
      check_edge_in_facet(edge, right, edge.direction.cross(right.normal), edge.inward.row(1), e);
      expect(edge.inward.row(0).dot(right.normal) <= 0x1p-51,
             "the left facet is below the right plane", e);
      expect(edge.inward.row(1).dot(left.normal) <= 0x1p-51,
             "the right facet is below the left plane", e);
    }
  }

  void check_edge_ends(const Edge& edge, std::size_t e) {
    const bool full_line = edge.begin == -kInfinity;
    expect(full_line || edge.begin == 0.0, "an edge begins at 0 or at -infinity", e);
    expect(full_line == (edge.vertex[0] == kNone), "only a full line has no first vertex", e);
    expect((edge.end == kInfinity) == (edge.vertex[1] == kNone),
           "an edge ends at its second vertex", e);
    expect(edge.end > 0.0, "edges have a length", e);
    if (edge.vertex[0] != kNone) {
      expect(edge.point == body_.vertices[at(edge.vertex[0])].position,
             "an edge starts at its vertex", e);
    }
    if (edge.vertex[1] != kNone) {
      const Vec3& end = body_.vertices[at(edge.vertex[1])].position;
      const Vec3 reached = edge.point + edge.end * edge.direction;
      expect((reached - end).norm() <= tolerance(end) + tolerance(edge.point) + 0x1p-50 * edge.end,
             "an edge reaches its second vertex", e);
    }
  }

  void check_edge_in_facet(const Edge& edge, const Facet& facet, const Vec3& across,
                           const Vec3& inward, std::size_t e) {
    expect(perpendicular(edge.direction, facet.normal), "an edge lies in its facets' planes", e);
    expect(std::abs(facet.normal.dot(edge.point) - facet.offset) <= tolerance(edge.point),
           "an edge's point is on its facets", e);
    expect(is_unit(inward), "inward vectors are unit", e);
    expect((inward - across).norm() <= 0x1p-49, "inward vectors cross the edge into their facet",
           e);
  }

  std::int32_t from(const EdgeUse& use) const {
    return body_.edges[at(use.edge)].vertex[use.side == 0 ? 0 : 1];
  }
  std::int32_t to(const EdgeUse& use) const {
    return body_.edges[at(use.edge)].vertex[use.side == 0 ? 1 : 0];
  }
  bool has_lines() const { return !body_.edges.empty() && body_.edges[0].begin == -kInfinity; }

  void check_facet_chains() {
    std::vector<int> uses(2 * body_.edges.size(), 0);
    for (std::size_t f = 0; f < body_.facets.size(); ++f) {
      const Facet& facet = body_.facets[f];
      for (std::int32_t i = 0; i < facet.sides; ++i) {
        const EdgeUse& use = body_.facet_edges[at(facet.first_side + i)];
        ++uses[2 * at(use.edge) + at(use.side)];
        expect(body_.edges[at(use.edge)].facet[use.side] == static_cast<std::int32_t>(f),
               "a facet's sides know it", f);
        if (has_lines()) continue;
        const bool last = i + 1 == facet.sides;
        const EdgeUse& next = body_.facet_edges[at(facet.first_side + (last ? 0 : i + 1))];
        expect(to(use) == from(next), "a facet's boundary is head to tail, open at most at its end",
               f);
        expect(last || to(use) != kNone, "a facet's boundary goes to infinity only last", f);
      }
      expect(facet.sides >= (body_.bounded()       ? 3
                             : has_lines()         ? 1
                             : body_.edges.empty() ? 0
                                                   : 2),
             "facets have enough sides", f);
    }
    if (body_.facets.empty()) return;
    for (std::size_t i = 0; i < uses.size(); ++i) {
      expect(uses[i] == 1, "each side of an edge bounds one facet", i / 2);
    }
  }

  void check_vertices() {
    std::vector<int> uses(2 * body_.edges.size(), 0);
    for (std::size_t v = 0; v < body_.vertices.size(); ++v) {
      const Vertex& vertex = body_.vertices[v];
      expect(body_.facets.empty() || vertex.edges >= 3, "a vertex has three edges or more", v);
      for (std::int32_t i = 0; i < vertex.edges; ++i) {
        const EdgeUse& use = body_.vertex_edges[at(vertex.first_edge + i)];
        ++uses[2 * at(use.edge) + at(use.side)];
        expect(body_.edges[at(use.edge)].vertex[use.side] == static_cast<std::int32_t>(v),
               "a vertex's edges know it", v);
        if (body_.facets.empty()) continue;
        const EdgeUse& next = body_.vertex_edges[at(vertex.first_edge + (i + 1) % vertex.edges)];
        expect(body_.edges[at(use.edge)].facet[use.side] ==
                   body_.edges[at(next.edge)].facet[1 - next.side],
               "a vertex's edges turn about it facet by facet", v);
      }
    }
    for (std::size_t e = 0; e < body_.edges.size(); ++e) {
      for (std::size_t k = 0; k < 2; ++k) {
        expect(uses[2 * e + k] == (body_.edges[e].vertex[k] == kNone ? 0 : 1),
               "an edge leaves each of its vertices once", e);
      }
    }
  }

  // Euler's formula: the surface of a bounded body is a sphere, that of an unbounded body with
  // vertices is a plane.
  void check_counts() {
    const auto vertices = static_cast<std::int64_t>(body_.vertices.size());
    const auto edges = static_cast<std::int64_t>(body_.edges.size());
    const auto facets = static_cast<std::int64_t>(body_.facets.size());
    if (facets == 0) {
      expect(vertices == edges + 1 && edges <= 1, "without facets: a point or a segment", 0);
    } else if (vertices > 0) {
      expect(vertices - edges + facets == (body_.bounded() ? 2 : 1), "Euler's formula holds", 0);
    } else if (edges > 0) {
      expect(edges == facets || edges == facets - 1,
             "full lines are one fewer than facets or as many", 0);
    } else {
      expect(facets <= 2, "without edges: a half-space or a slab", 0);
    }
  }

  void check_containment() {
    for (const Facet& facet : body_.facets) {
      const Vec3& point = body_.point_of(facet);
      for (std::size_t a = 0; a < body_.anchors.size(); ++a) {
        const double height = facet.normal.dot(body_.anchors[a] - point);
        expect(height <= tolerance(body_.anchors[a]) + tolerance(point),
               "anchors are below every facet's plane", a);
      }
      for (std::size_t r = 0; r < body_.rays.size(); ++r) {
        expect(facet.normal.dot(body_.rays[r].direction.normalized()) <= 0x1p-50,
               "rays do not leave through a facet", r);
      }
      expect(facet.normal.dot(body_.interior - point) <= tolerance(point),
             "the interior point is inside", 0);
      const double inside = facet.offset - facet.normal.dot(body_.interior);
      expect(body_.inner_radius == 0.0 || inside >= body_.inner_radius, "the inner ball is inside",
             0);
    }
    expect(body_.inner_radius >= 0.0, "the inner radius is a length", 0);
  }

  void check_summary() {
    const std::size_t anchors =
        body_.vertices.empty() ? (body_.edges.empty() ? body_.facets.size() : body_.edges.size())
                               : body_.vertices.size();
    expect(body_.anchors.size() == anchors, "anchors are vertices, lines or planes", anchors);
    for (std::size_t v = 0; v < body_.vertices.size() && v < body_.anchors.size(); ++v) {
      expect(body_.anchors[v] == body_.vertices[v].position, "anchors are the vertices", v);
    }
    for (std::size_t a = 0; a < body_.anchors.size(); ++a) {
      expect(body_.anchors[a].norm() <= body_.bounding_radius,
             "anchors are within the bounding radius", a);
    }
    for (std::size_t r = 0; r < body_.rays.size(); ++r) {
      expect(body_.rays[r].exact || is_unit(body_.rays[r].direction), "rounded rays are unit", r);
    }
    const bool open = std::any_of(body_.edges.begin(), body_.edges.end(),
                                  [](const Edge& edge) { return edge.end == kInfinity; });
    expect(body_.bounded() == !(open || (body_.edges.empty() && !body_.facets.empty())),
           "bodies with rays, and no others, are unbounded", 0);
    expect(body_.position_error >= 0.0 && std::isfinite(body_.position_error),
           "the position error is a length", 0);
    expect(body_.radius >= 0.0 && std::isfinite(body_.radius), "the radius is a length", 0);
    expect(body_.interior.allFinite(), "the interior point is finite", 0);
  }

  const ConvexBody& body_;
  std::vector<std::string> broken_;
};

}  // namespace

std::vector<std::string> broken_invariants(const ConvexBody& body) {
  return Inspection(body).run();
}

}  // namespace clearance
