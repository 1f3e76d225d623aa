// Makes the doubles of the queries from an exact solid: rounds every number once, then joins the
// features.
#include <algorithm>
#include <cmath>

#include "core/construction/centre.hpp"
#include "core/construction/exact_polyhedron.hpp"
#include "core/construction/rounded_once.hpp"
#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"
#include "core/query_tables.hpp"

namespace clearance::exact {
namespace {

// Rounds the solid's numbers and keeps the largest error made.
class Rounder {
 public:
  double quotient(const Integer& numerator, const Integer& denominator) {
    return noted(nearest_quotient(numerator, denominator));
  }

  double over_root(const Integer& numerator, const Integer& square) {
    return noted(nearest_over_root(numerator, square));
  }

  Vec3 point(const Integer4& node) {
    Vec3 result;
    Vec3 error = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const Rounded rounded = nearest_quotient(node[i], node[3]);
      const auto axis = static_cast<Eigen::Index>(i);
      result[axis] = rounded.value;
      error[axis] = error_of(rounded);
    }
    note(error.norm() * kRoundedUp);
    return result;
  }

  [[nodiscard]] double error() const { return error_; }

 private:
  static double error_of(const Rounded& rounded) {
    if (rounded.exact) return 0.0;
    return std::max(kUlp * std::abs(rounded.value), std::numeric_limits<double>::min());
  }

  void note(double error) { error_ = std::max(error_, error); }

  double noted(const Rounded& rounded) {
    note(error_of(rounded));
    return rounded.value;
  }

  double error_ = 0.0;
};

Integer squared_norm(const Integer3& v) { return dot(v, v); }

Vec3 unit_cross(const Integer3& a, const Integer3& b) { return unit(cross(a, b)); }

class Assembler {
 public:
  explicit Assembler(const Solid& solid) : solid_(solid) {}

  ConvexBody build() {
    for (const Integer4& plane : solid_.planes) add_facet(plane);
    for (const Integer4& node : solid_.nodes) body_.anchors.push_back(rounder_.point(node));
    for (const SolidEdge& edge : solid_.edges) add_edge(edge);
    join_facets();
    const bool lines = std::any_of(solid_.edges.begin(), solid_.edges.end(),
                                   [](const SolidEdge& edge) { return edge.full_line; });
    if (!lines) add_vertices();
    if (solid_.nodes.empty()) anchor_bare_planes();
    place_facet_points();
    if (!solid_.rays.empty()) add_rays();
    body_.position_error = rounder_.error();
    return std::move(body_);
  }

 private:
  void add_facet(const Integer4& plane) {
    const Integer3 normal = head(plane);
    body_.facets.push_back(
        {unit(normal), rounder_.over_root(plane[3], squared_norm(normal)), 0, 0, 0, 0});
  }

  void add_edge(const SolidEdge& edge) {
    const Integer3 left = head(solid_.planes[at(edge.left)]);
    const Integer3 right = head(solid_.planes[at(edge.right)]);
    const Integer3 direction = cross(left, right);
    Edge result;
    result.point = body_.anchors[at(edge.start)];
    result.direction = unit(direction);
    result.begin = edge.full_line ? -kInfinity : 0.0;
    result.end = edge.full_line || edge.end == kNone ? kInfinity : length(edge);
    result.vertex[0] = edge.full_line ? kNone : edge.start;
    result.vertex[1] = edge.full_line ? kNone : edge.end;
    result.facet[0] = edge.left;
    result.facet[1] = edge.right;
    // In the planes of the facets, at right angles to the edge.
    result.inward.row(0) = unit_cross(left, direction);
    result.inward.row(1) = unit_cross(direction, right);
    body_.edges.push_back(result);
  }

  double length(const SolidEdge& edge) {
    const Integer4& a = solid_.nodes[at(edge.start)];
    const Integer4& b = solid_.nodes[at(edge.end)];
    Integer3 difference;
    for (std::size_t i = 0; i < 3; ++i) difference[i] = b[i] * a[3] - a[i] * b[3];
    // |difference| / weight = squared / (weight |difference|)
    const Integer weight = a[3] * b[3];
    const Integer squared = squared_norm(difference);
    return rounder_.over_root(squared, squared * weight * weight);
  }

  // An edge as listed by one of its facets: from `from` to `to` (kNone: infinity), with the facet
  // on the left.
  struct Side {
    int from, to;
    EdgeUse use;
  };

  void join_facets() {
    std::vector<std::vector<Side>> sides(solid_.planes.size());
    for (std::size_t e = 0; e < solid_.edges.size(); ++e) {
      const SolidEdge& edge = solid_.edges[e];
      const int start = edge.full_line ? kNone : edge.start;
      const int end = edge.full_line ? kNone : edge.end;
      const auto number = static_cast<std::int32_t>(e);
      sides[at(edge.left)].push_back({start, end, {number, 0}});
      sides[at(edge.right)].push_back({end, start, {number, 1}});
    }
    for (std::size_t f = 0; f < sides.size(); ++f) {
      body_.facets[f].first_side = static_cast<std::int32_t>(body_.facet_edges.size());
      body_.facets[f].sides = static_cast<std::int32_t>(sides[f].size());
      chain(sides[f]);
      add_sharp_corners(body_.facets[f]);
      fill_row(body_.facet_edges);
    }
  }

  // Orders the sides head to tail. An open chain starts with the side that comes from infinity, a
  // closed one anywhere.
  void chain(std::vector<Side>& sides) {
    std::sort(sides.begin(), sides.end(),
              [](const Side& a, const Side& b) { return a.from < b.from; });
    if (sides.empty()) return;
    std::size_t next = 0;
    for (std::size_t i = 0; i < sides.size(); ++i) {
      body_.facet_edges.push_back(sides[next].use);
      const int reached = sides[next].to;
      if (reached == kNone) {
        next = i + 1;  // only full lines go on after infinity
      } else {
        next = static_cast<std::size_t>(
            std::lower_bound(sides.begin(), sides.end(), reached,
                             [](const Side& side, int from) { return side.from < from; }) -
            sides.begin());
      }
    }
  }

  // At a sharp vertex a point may be past the vertex although it violates neither side by more than
  // rounding. The facet gets one limit more there: across the end of the first side.
  void add_sharp_corners(Facet& facet) {
    facet.limits = facet.sides;
    const auto use_of = [&](std::int32_t i) {
      return body_.facet_edges[at(facet.first_side + i % facet.sides)];
    };
    const auto along = [&](const EdgeUse& use) {
      const Vec3& direction = body_.edges[at(use.edge)].direction;
      return use.side == 0 ? direction : Vec3(-direction);
    };
    for (std::int32_t i = 0; i < facet.sides; ++i) {
      const EdgeUse use = use_of(i), next = use_of(i + 1);
      const std::int32_t vertex = body_.edges[at(use.edge)].vertex[1 - use.side];
      if (vertex == kNone) continue;  // the end of an open chain
      if (!(-along(use).dot(along(next)) > kSharpCorner)) continue;
      body_.facet_edges.push_back(use);
      ++facet.limits;
    }
  }

  void add_vertices() {
    std::vector<std::vector<EdgeUse>> around(solid_.nodes.size());
    for (std::size_t e = 0; e < solid_.edges.size(); ++e) {
      const auto number = static_cast<std::int32_t>(e);
      const SolidEdge& edge = solid_.edges[e];
      around[at(edge.start)].push_back({number, 0});
      if (edge.end != kNone) around[at(edge.end)].push_back({number, 1});
    }
    for (std::size_t v = 0; v < around.size(); ++v) {
      body_.vertices.push_back({body_.anchors[v],
                                static_cast<std::int32_t>(body_.vertex_edges.size()),
                                static_cast<std::int32_t>(around[v].size())});
      order_around(around[v]);
      fill_row(body_.vertex_edges);
    }
  }

  // The next row begins with a new four: VectorRows.
  static void fill_row(std::vector<EdgeUse>& uses) {
    while (uses.size() % 4 != 0) uses.push_back(EdgeUse(uses.back()));
  }

  // Counter-clockwise as seen from outside: an edge's left facet, leaving the vertex, is the next
  // one's right.
  void order_around(std::vector<EdgeUse>& uses) {
    const auto right_of = [this](const EdgeUse& use) {
      return body_.edges[at(use.edge)].facet[1 - use.side];
    };
    const auto left_of = [this](const EdgeUse& use) {
      return body_.edges[at(use.edge)].facet[use.side];
    };
    std::sort(uses.begin(), uses.end(),
              [&](const EdgeUse& a, const EdgeUse& b) { return right_of(a) < right_of(b); });
    std::size_t next = 0;
    for (std::size_t i = 0; i < uses.size(); ++i) {
      body_.vertex_edges.push_back(uses[next]);
      next = static_cast<std::size_t>(
          std::lower_bound(uses.begin(), uses.end(), left_of(uses[next]),
                           [&](const EdgeUse& use, int facet) { return right_of(use) < facet; }) -
          uses.begin());
    }
  }

  // For a half-space and a slab: takes each plane's point nearest to the origin.
  void anchor_bare_planes() {
    for (const Integer4& plane : solid_.planes) {
      const Integer3 normal = head(plane);
      body_.anchors.push_back(
          rounder_.point({Integer(normal[0] * plane[3]), Integer(normal[1] * plane[3]),
                          Integer(normal[2] * plane[3]), squared_norm(normal)}));
    }
  }

  // The rays and lines of an unbounded body, exactly where doubles can hold them.
  void add_rays() {
    for (const Integer3& ray : solid_.rays) {
      const RoundedDirection direction = nearest_direction(ray);
      body_.rays.push_back({direction.vector, direction.exact, is_line(ray)});
    }
  }

  [[nodiscard]] bool is_line(const Integer3& ray) const {
    return std::ranges::any_of(solid_.rays, [&](const Integer3& other) {
      return squared_norm(cross(ray, other)) == 0 && sgn(dot(ray, other)) < 0;
    });
  }

  // For each facet, takes the point of `anchors` that is nearest to the origin: it has the smallest
  // rounding error.
  void place_facet_points() {
    for (std::size_t f = 0; f < body_.facets.size(); ++f) {
      Facet& facet = body_.facets[f];
      if (facet.sides == 0) {
        facet.anchor = static_cast<std::int32_t>(f);
        continue;
      }
      double nearest = kInfinity;
      for (std::int32_t i = 0; i < facet.sides; ++i) {
        const EdgeUse& use = body_.facet_edges[at(facet.first_side + i)];
        const double square = body_.edges[at(use.edge)].point.squaredNorm();
        if (square >= nearest) continue;
        nearest = square;
        facet.anchor = solid_.edges[at(use.edge)].start;
      }
    }
  }

  const Solid& solid_;
  ConvexBody body_;
  Rounder rounder_;
};

// Below this angle, as a sine, two unbounded directions are refused that are not exactly opposite.
constexpr double kLeastOpening = 0x1p-20;

bool opens_wide_enough(const std::vector<Ray>& rays) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3 direction = rays[i].direction.normalized();
    for (std::size_t k = 0; k < i; ++k) {
      const Vec3 other = rays[k].direction.normalized();
      const bool opposite = direction.dot(other) < 0.0;
      if (opposite && rays[i].is_line && rays[k].is_line) continue;
      if (!(direction.cross(other).norm() >= kLeastOpening)) return false;
    }
  }
  return true;
}

// The least thickness along any facet's normal, m.
double thickness(const ConvexBody& body) {
  double least = kInfinity;
  for (const Facet& facet : body.facets) {
    const Vec3 back = -facet.normal;
    const bool ends = std::ranges::all_of(
        body.rays, [&](const Ray& ray) { return back.dot(ray.direction) <= kDerivativeError; });
    if (ends) least = std::min(least, facet.offset + support(body, back).value);
  }
  return least;
}

}  // namespace

ShapeResult rounded_polyhedron(const Solid& solid) {
  ConvexBody body = Assembler(solid).build();
  if (!opens_wide_enough(body.rays)) {
    return ShapeError{
        "the body is unbounded and opens by less than 1e-6 rad, or by that much less than half a "
        "turn: accepted are wider openings, half a turn itself, and parallel planes"};
  }
  double farthest = 0.0;
  for (const Vec3& anchor : body.anchors) {
    if (!(anchor.cwiseAbs().maxCoeff() <= kLargestCoordinate)) {
      return ShapeError{"a vertex lies more than 1e12 m from the origin"};
    }
    farthest = std::max(farthest, anchor.norm());
  }
  body.bounding_radius = farthest * kRoundedUp;
  Vec3 inside;
  for (std::size_t i = 0; i < 3; ++i) {
    inside[static_cast<Eigen::Index>(i)] =
        nearest_quotient(solid.interior[i], solid.interior[3]).value;
  }
  body.interior = well_inside(body, inside);
  add_query_tables(body);
  if (thickness(body) < kLeastExtent) return ShapeError{"the body is thinner than 1e-12 m"};
  return body;
}

}  // namespace clearance::exact
