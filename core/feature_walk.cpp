#include "core/feature_walk.hpp"

#include <algorithm>
#include <cmath>

#include "core/rounding.hpp"

namespace clearance {
namespace {

// Enough for 99.9 % of the tracked queries of the facet-ball workload; more is the loop's work.
constexpr int kSteps = 24;

enum class Step { kHolds, kMoved, kLost };

using Side = TrackingState::Side;

void to_vertex(Side& side, std::int32_t vertex) noexcept {
  side.dimension = 0;
  side.feature = vertex;
}
void to_edge(Side& side, std::int32_t edge) noexcept {
  side.dimension = 1;
  side.feature = edge;
}
void to_facet(Side& side, std::int32_t facet) noexcept {
  side.dimension = 2;
  side.feature = facet;
}

// The steepest of a vertex's edges along g.
struct Steepest {
  double rate = -kInfinity;
  std::int32_t at = 0;  // index into vertex_edges
};

Steepest steepest(const ConvexPolyhedron& body, const Vertex& vertex, const Vec3& g) noexcept {
  Steepest best;
  for (std::int32_t i = vertex.first_edge; i < vertex.first_edge + vertex.edges; ++i) {
    const double rate = body.outgoing[i].dot(g);
    if (rate > best.rate) best = {rate, i};
  }
  return best;
}

// How steeply the facets beside an edge rise along g; a segment's only edge has none.
double steepest_side(const Edge& edge, const Vec3& g) noexcept {
  if (edge.facet[0] == kNone) return -kInfinity;
  return std::max(edge.inward[0].dot(g), edge.inward[1].dot(g));
}

// From a vertex along an edge that approaches the other's point: onto the edge, or past it to its
// far end.
void leave_vertex(const ConvexPolyhedron& body, Side& side, const Steepest& way) noexcept {
  const EdgeUse& use = body.vertex_edges[way.at];
  const Edge& edge = body.edges[use.edge];
  if (way.rate >= edge.end && edge.vertex[1 - use.side] != kNone) {
    to_vertex(side, edge.vertex[1 - use.side]);
  } else {
    to_edge(side, use.edge);
  }
}

Step vertex_vertex(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const RelativePose& pose,
                   TrackingState& state, ClosestFeatures& c) noexcept {
  const Vertex& v = a.vertices[state.a.feature];
  const Vertex& w = b.vertices[state.b.feature];
  c.point_a = v.position;
  c.own_b = w.position;
  c.point_b = pose.rotation * w.position + pose.translation;
  const Vec3 g = c.point_b - c.point_a;
  const double apart = g.norm(), limit = -kCertainRate * apart;
  c.apart = c.proved = apart;
  c.normal = g / apart;
  const Steepest on_a = steepest(a, v, g);
  const Steepest on_b = steepest(b, w, -(pose.rotation.transpose() * g));
  if (on_a.rate < limit && on_b.rate < limit) return Step::kHolds;
  if (on_a.rate > -limit && on_a.rate >= on_b.rate) {
    leave_vertex(a, state.a, on_a);
  } else if (on_b.rate > -limit) {
    leave_vertex(b, state.b, on_b);
  } else {
    return Step::kLost;
  }
  return Step::kMoved;
}

// One of the bodies (the owner of an edge or facet) as seen from the other. kMoved: the owner is B.
template <bool kMoved>
struct Owner {
  const RelativePose& a_from_b;

  [[nodiscard]] Vec3 point_in(const Vec3& p) const noexcept {
    return kMoved ? Vec3(a_from_b.rotation.transpose() * (p - a_from_b.translation))
                  : Vec3(a_from_b.rotation * p + a_from_b.translation);
  }
  [[nodiscard]] Vec3 direction_out(const Vec3& v) const noexcept {
    return kMoved ? Vec3(a_from_b.rotation * v) : Vec3(a_from_b.rotation.transpose() * v);
  }
  // What was found in the owner's frame; n: unit, from the owner towards the other.
  void express(const Vec3& on_owner, const Vec3& on_other, const Vec3& n,
               ClosestFeatures& c) const noexcept {
    c.point_a = kMoved ? on_other : on_owner;
    c.own_b = kMoved ? on_owner : on_other;
    c.point_b = a_from_b.rotation * c.own_b + a_from_b.translation;
    c.normal = kMoved ? Vec3(-(a_from_b.rotation * n)) : n;
  }
};

template <bool kMoved>
Step edge_vertex(const ConvexPolyhedron& owner, Side& on_owner, const ConvexPolyhedron& other,
                 Side& on_other, const Owner<kMoved>& frame, ClosestFeatures& c) noexcept {
  const Edge& edge = owner.edges[on_owner.feature];
  const Vertex& vertex = other.vertices[on_other.feature];
  const Vec3 from_start = frame.point_in(vertex.position) - edge.point;
  const double s = from_start.dot(edge.direction);
  if (!(s > edge.begin)) return to_vertex(on_owner, edge.vertex[0]), Step::kMoved;
  if (!(s < edge.end)) return to_vertex(on_owner, edge.vertex[1]), Step::kMoved;
  const Vec3 rough = from_start - s * edge.direction;
  const Vec3 g = rough - rough.dot(edge.direction) * edge.direction;  // what cancellation has left
  const double apart = g.norm(), limit = -kCertainRate * apart;
  const double side = steepest_side(edge, g);
  if (!(side < limit)) {
    if (!(side > -limit)) return Step::kLost;
    return to_facet(on_owner, edge.facet[edge.inward[0].dot(g) == side ? 0 : 1]), Step::kMoved;
  }
  const Steepest away = steepest(other, vertex, -frame.direction_out(g));
  if (!(away.rate < limit)) {
    if (!(away.rate > -limit)) return Step::kLost;
    return to_edge(on_other, other.vertex_edges[away.at].edge), Step::kMoved;
  }
  c.apart = c.proved = apart;
  frame.express(edge.point + s * edge.direction, vertex.position, g / apart, c);
  return Step::kHolds;
}

template <bool kMoved>
Step facet_vertex(const ConvexPolyhedron& owner, Side& on_owner, const ConvexPolyhedron& other,
                  Side& on_other, const Owner<kMoved>& frame, ClosestFeatures& c) noexcept {
  const Facet& facet = owner.facets[on_owner.feature];
  const Vertex& vertex = other.vertices[on_other.feature];
  const Vec3 tip = frame.point_in(vertex.position);
  const double apart = facet.normal.dot(tip) - facet.offset;
  if (!(apart > 0.0)) return Step::kLost;
  double least = 0.0;
  std::int32_t outside = kNone;
  for (std::int32_t i = facet.first_side; i < facet.first_side + facet.sides; ++i) {
    const FacetSide& side = owner.facet_sides[i];
    const double within = side.inward.dot(tip) - side.offset;
    if (within < least) {
      least = within;
      outside = owner.facet_edges[i].edge;
    }
  }
  if (outside != kNone) return to_edge(on_owner, outside), Step::kMoved;
  const Steepest away = steepest(other, vertex, -frame.direction_out(facet.normal));
  if (!(away.rate < -kCertainRate)) {
    const EdgeUse& use = other.vertex_edges[away.at];
    const std::int32_t next = other.edges[use.edge].vertex[1 - use.side];
    if (!(away.rate > kCertainRate) || next == kNone) return Step::kLost;
    return to_vertex(on_other, next), Step::kMoved;
  }
  c.apart = c.proved = apart;
  frame.express(tip - apart * facet.normal, vertex.position, facet.normal, c);
  return Step::kHolds;
}

// Where the line's closest point lies beyond an end of the edge, that end takes over.
bool beyond_end(const Edge& edge, double at, Side& side) noexcept {
  if (at > edge.begin && at < edge.end) return false;
  to_vertex(side, edge.vertex[at > edge.begin ? 1 : 0]);
  return true;
}

Step edge_edge(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const RelativePose& pose,
               TrackingState& state, ClosestFeatures& c) noexcept {
  const Edge& first = a.edges[state.a.feature];
  const Edge& second = b.edges[state.b.feature];
  if (!a.bounded() || !b.bounded()) return Step::kLost;
  const Vec3 e = first.direction, f = pose.rotation * second.direction;
  const Vec3 start_b = pose.rotation * second.point + pose.translation;
  const Vec3 between = start_b - first.point;
  const Vec3 n = e.cross(f);
  const double sine2 = n.squaredNorm();
  if (!(sine2 > kCrossingSine2)) return Step::kLost;
  const double cosine = e.dot(f), along_e = between.dot(e);
  const double t = (cosine * along_e - between.dot(f)) / sine2;
  const double s = along_e + cosine * t;
  if (beyond_end(first, s, state.a) || beyond_end(second, t, state.b)) return Step::kMoved;
  const double sine = std::sqrt(sine2), apart = between.dot(n) / sine;
  c.normal = n / std::copysign(sine, apart);
  const Vec3 m = pose.rotation.transpose() * c.normal;
  const double on_a = steepest_side(first, c.normal), on_b = steepest_side(second, -m);
  if (!(on_a < -kCertainRate) || !(on_b < -kCertainRate)) return Step::kLost;
  c.point_a = first.point + s * e;
  c.own_b = second.point + t * second.direction;
  c.point_b = start_b + t * f;
  c.apart = (c.point_b - c.point_a).norm();
  // Along an edge the body may reach farther by what rounding tilts the normal.
  c.proved = std::abs(apart) - 2.0 * (a.bounding_radius * std::abs(c.normal.dot(e)) +
                                      b.bounding_radius * std::abs(c.normal.dot(f)));
  return Step::kHolds;
}

Step step(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const RelativePose& a_from_b,
          TrackingState& state, ClosestFeatures& c) noexcept {
  const Owner<false> of_a{a_from_b};
  const Owner<true> of_b{a_from_b};
  switch (state.a.dimension * 3 + state.b.dimension) {
    case 0:
      return vertex_vertex(a, b, a_from_b, state, c);
    case 1:
      return edge_vertex(b, state.b, a, state.a, of_b, c);
    case 2:
      return facet_vertex(b, state.b, a, state.a, of_b, c);
    case 3:
      return edge_vertex(a, state.a, b, state.b, of_a, c);
    case 4:
      return edge_edge(a, b, a_from_b, state, c);
    case 6:
      return facet_vertex(a, state.a, b, state.b, of_a, c);
    default:
      return Step::kLost;
  }
}

bool exists(const ConvexPolyhedron& body, const Side& side) noexcept {
  const std::size_t count = side.dimension == 0   ? body.vertices.size()
                            : side.dimension == 1 ? body.edges.size()
                            : side.dimension == 2 ? body.facets.size()
                                                  : 0;
  return static_cast<std::size_t>(static_cast<std::uint32_t>(side.feature)) < count;
}

// A vertex that is far out along `towards`; a body without vertices is one facet, or the loop's.
void start(const ConvexPolyhedron& body, const Vec3& towards, Side& side) noexcept {
  if (!body.vertices.empty()) {
    to_vertex(side, body.start.at(towards));
  } else {
    to_facet(side, 0);
  }
}

void start(const ConvexPolyhedron& a, const ConvexPolyhedron& b, const RelativePose& pose,
           TrackingState& state) noexcept {
  const Vec3 towards = pose.rotation * b.interior + pose.translation - a.interior;
  start(a, towards, state.a);
  start(b, -(pose.rotation.transpose() * towards), state.b);
}

}  // namespace

bool walk_features(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                   const RelativePose& a_from_b, TrackingState& state,
                   ClosestFeatures& closest) noexcept {
  if (!a.bounded() && !b.bounded()) return false;
  if (!exists(a, state.a) || !exists(b, state.b)) start(a, b, a_from_b, state);
  for (closest.steps = 1; closest.steps <= kSteps; ++closest.steps) {
    const Step result = step(a, b, a_from_b, state, closest);
    if (result != Step::kMoved) return result == Step::kHolds;
  }
  return false;
}

}  // namespace clearance
