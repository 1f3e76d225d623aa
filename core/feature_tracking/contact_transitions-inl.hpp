// Transitions of bodies that touch at a corner or at an edge. Compiled once per vector width: see
// core/numerics/vec4-inl.hpp.
//
// The points of such features meet, so the vector between them has no direction. But any unit
// vector n certifies the contact if the features are the support sets of both bodies along n. These
// vectors are the intersection of two cones, those of the features' outward normals:
// - An edge and a vertex: the edge's normals are an arc, and each edge of the vertex cuts off one
//   end of it. What is left is known at once, and n is its middle.
// - Two vertices: n starts between the middles of the two cones. While an edge approaches along n,
//   n is reflected at the plane across that edge. This ends if the intersection has an inside
//   (Motzkin and Schoenberg 1954); narrow ones are left to the search.
#if defined(CLEARANCE_CORE_CONTACT_TRANSITIONS) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_CONTACT_TRANSITIONS
#undef CLEARANCE_CORE_CONTACT_TRANSITIONS
#else
#define CLEARANCE_CORE_CONTACT_TRANSITIONS
#endif

#include <algorithm>
#include <cmath>

#include "core/feature_tracking/transitions-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Edges whose lines are nearer than this, as a part of the size, may have come from a contact.
inline constexpr double kNearContact = 0x1p-6;
inline constexpr int kMostReflections = 16;
// A reflection ends at least so far (as a derivative) on the other side of its plane.
inline constexpr double kPastPlane = 0x1p-40;

// The transition of disjoint bodies, compiled once for all that may touch.
inline HWY_NOINLINE Transition disjoint_transition(TrackedPair& pair) { return transition(pair); }

// A direction in the middle of a vertex's outward normals, in the body's frame; not of unit length.
inline Vec4 middle_normal(const ConvexBody& body, const Vertex& vertex) {
  Vec4 sum = spread(0.0);
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    if (body.facets.empty()) {
      sum = sum - load3(body.outgoing_of(vertex, i));
    } else {
      sum = sum + load3_padded(body.facets[facet_around(body, vertex, i)].normal);
    }
  }
  return sum;
}
HWY_INLINE Vec4 unit_or_zero(Vec4 v) {
  const double length = norm(v);
  return length > 0.0 ? over(v, length) : spread(0.0);
}

// Finds a direction along which both vertices are support points by more than rounding. False:
// there is none, or too few reflections were made.
inline HWY_NOINLINE bool separate_vertices(TrackedPair& pair, const Vertex& vertex_a,
                                           const Vertex& vertex_b) {
  const RelativePose4& pose = pair.a_from_b;
  Vec4 n = unit_or_zero(middle_normal(pair.a, vertex_a)) -
           direction_to_a(pose, unit_or_zero(middle_normal(pair.b, vertex_b)));
  for (int reflections = 0; reflections <= kMostReflections; ++reflections) {
    const double length = norm(n);
    if (!(length > 0.0)) return false;
    n = over(n, length);
    const SteepestEdge from_a = steepest(pair.a, vertex_a, n);
    const SteepestEdge from_b = steepest(pair.b, vertex_b, -direction_to_b(pose, n));
    const double greatest = std::max(from_a.derivative, from_b.derivative);
    if (greatest < -kDerivativeError) {
      pair.found.n_A = n;
      return true;
    }
    const bool is_of_a = from_a.derivative >= from_b.derivative;
    const Vec4 across =
        is_of_a ? load3(pair.a.outgoing_of(vertex_a, from_a.at - vertex_a.first_edge))
                : -direction_to_a(
                      pose, load3(pair.b.outgoing_of(vertex_b, from_b.at - vertex_b.first_edge)));
    n = n - spread(2.0 * greatest + kPastPlane) * across;
  }
  return false;
}

// Two vertices that may touch.
inline HWY_NOINLINE Transition touching_vertices(TrackedPair& pair) {
  const Vertex& vertex_a = pair.a.vertices[pair.on_a.feature];
  const Vertex& vertex_b = pair.b.vertices[pair.on_b.feature];
  pair.found.a_A = load3_masked(vertex_a.position);
  pair.found.b_B = load3_masked(vertex_b.position);
  pair.found.b_A = point_to_a(pair.a_from_b, pair.found.b_B);
  const Vec4 between = pair.found.b_A - pair.found.a_A;
  pair.found.distance = norm(between);
  if (!(pair.found.distance <= kMayTouch * size_of(pair))) return disjoint_transition(pair);
  if (!separate_vertices(pair, vertex_a, vertex_b)) return Transition::kUndecided;
  pair.found.certified = dot(pair.found.n_A, between);
  return Transition::kClosest;
}

// The part of an edge's arc of normals, from 0 at its left facet to 1 at its right one, along which
// no edge of a vertex of the other body approaches. `left`, `right`: against the facets' normals,
// in the vertex's frame.
inline HWY_NOINLINE Span common_normals(const ConvexBody& body, const Vertex& vertex,
                                        const Vec3& left, const Vec3& right) {
  Span arc{0.0, 1.0};
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const Vec3 out = body.outgoing_of(vertex, i);
    const double at_left = dot(out, left), at_right = dot(out, right);
    if (at_left < 0.0 && at_right < 0.0) continue;
    if (!(at_left < 0.0 || at_right < 0.0)) return {0.0, 0.0};
    const double crossing = at_left / (at_left - at_right);
    if (at_left < 0.0) {
      arc.to = std::min(arc.to, crossing);
    } else {
      arc.from = std::max(arc.from, crossing);
    }
  }
  return arc;
}

// An edge of the owner and a vertex of the other body that may touch.
template <bool kIsB>
inline HWY_NOINLINE Transition touching_edge(const Owner<kIsB>& owner) {
  TrackedPair& pair = owner.pair;
  const Edge& edge = owner.body().edges[owner.side().feature];
  const Vertex& vertex = owner.other_body().vertices[owner.other_side().feature];
  EdgeAndVertex<kIsB> line(owner.a_from_b, load3_padded(edge.point), load3_padded(edge.direction),
                           load3_masked(vertex.position));
  const bool within_ends = line.s > edge.begin && line.s < edge.end;
  const Vec4 on_edge = line.start_A + line.s * line.e_A, across = line.tip_A - on_edge;
  pair.found.distance = norm(across);
  if (!within_ends || !(pair.found.distance <= kMayTouch * size_of(pair)))
    return disjoint_transition(pair);
  if (edge.facet[0] == kNone || !owner.body().bounded()) return Transition::kUndecided;
  const Vec4 left = load3_padded(owner.body().facets[edge.facet[0]].normal),
             right = load3_padded(owner.body().facets[edge.facet[1]].normal);
  const Span arc = common_normals(owner.other_body(), vertex, vec3(-owner.direction_L_to_O(left)),
                                  vec3(-owner.direction_L_to_O(right)));
  if (arc.empty()) return Transition::kUndecided;
  const Vec4 outward =
      owner.direction_L_to_A(left + spread(0.5 * (arc.from + arc.to)) * (right - left));
  const Vec4 n = over(outward, norm(outward));
  if (!both_facets_recede(edge, owner.direction_A_to_L(n), -kDerivativeError) ||
      !all_edges_recede(owner.other_body(), vertex, -owner.opposite().direction_A_to_L(n),
                        -kDerivativeError)) {
    return Transition::kUndecided;
  }
  owner.place(pair.found, line.start_L + line.s * line.e_L, on_edge, line.tip_O, line.tip_A);
  pair.found.n_A = kIsB ? -n : n;
  // The edge is the support set but for the tilt of n against it.
  pair.found.certified =
      dot(n, across) - 2.0 * owner.body().bounding_radius * std::abs(dot(n, line.e_A));
  return Transition::kClosest;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
