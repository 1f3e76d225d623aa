// A body's flat, a facet or a cap, and the other body's point nearest to its plane. Compiled once a
// vector width: see core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_FLAT) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_FLAT
#undef CLEARANCE_CORE_FLAT
#else
#define CLEARANCE_CORE_FLAT
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/own_support-inl.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

struct Flat {
  Vec4 normal;  // outward, unit
  double offset;
};
HWY_INLINE Flat flat_of(const ConvexBody& body, std::int32_t number) {
  const auto at = static_cast<std::size_t>(number - first_flat(body));
  if (body.is_curved()) {
    const double up = at == 0 ? -1.0 : 1.0;
    return {vec4(0.0, 0.0, up, 0.0), up * body.curved.discs[at].height};
  }
  const Facet& facet = body.facets[at];
  return {load3(facet.normal), facet.offset};
}

// Of three vertices, the facet that they are of, as a flat; kNone: there is none.
inline HWY_NOINLINE std::int32_t facet_of(const ConvexBody& body, const SidePieces& active) {
  const auto vertex = [&](std::size_t i) -> const Vertex& {
    return body.vertices[static_cast<std::size_t>(active.number(i))];
  };
  const double tolerance = 0x1p-40 * body.bounding_radius;
  for (std::int32_t i = 0; i < vertex(0).edges; ++i) {
    const EdgeUse& use = body.vertex_edges[static_cast<std::size_t>(vertex(0).first_edge + i)];
    for (const std::int32_t facet : body.edges[static_cast<std::size_t>(use.edge)].facet) {
      if (facet == kNone) continue;
      const Facet& f = body.facets[static_cast<std::size_t>(facet)];
      const auto is_on = [&](const Vertex& v) {
        return std::abs(f.normal.dot(v.position) - f.offset) <= tolerance;
      };
      if (is_on(vertex(1)) && is_on(vertex(2))) return first_flat(body) + facet;
    }
  }
  return kNone;
}

enum class FlatEnd { kClosest, kBeside, kUnknown };

struct FlatMeeting {
  FlatEnd end = FlatEnd::kUnknown;
  double lower, upper;     // the other body is so far above the flat's plane
  Vec4 own, above, below;  // its nearest point; the same and what is below it, in the flat's frame
  std::int32_t piece;      // of the other body
  std::int32_t edge = kNone;  // of a facet beside which that is
};

// Is the other body's nearest point above the flat? `number`: of A's if kOfA. `piece`: of the other
// body, as far as known.
template <bool kOfA>
HWY_INLINE FlatMeeting meet_flat(const ConvexBody& body, const ConvexBody& other,
                                 const RelativePose4& a_from_b, std::int32_t number,
                                 std::int32_t piece) {
  const Flat flat = flat_of(body, number);
  const Vec4 down =
      -(kOfA ? direction_to_b(a_from_b, flat.normal) : direction_to_a(a_from_b, flat.normal));
  FlatMeeting found;
  PiecePair pieces{piece, piece};
  const double whole = 1.0;
  const SidePieces one{&pieces, &whole, 1, &PiecePair::a};
  OwnSupport there = own_support(other, one, down);
  if (there.missing != kNone) {
    pieces.a = there.missing;
    there = own_support(other, one, down);
  }
  if (!there.known || there.missing != kNone) return found;
  found.piece = pieces.a;
  found.own = there.point;
  found.above = kOfA ? point_to_a(a_from_b, there.point) : point_to_b(a_from_b, there.point);
  found.upper = dot(flat.normal, found.above) - flat.offset;
  found.lower = found.upper - std::max(0.0, there.reach - dot(down, there.point));
  const bool above = found.lower > 0.0;
  if (!above && !body.is_curved()) return found;
  found.below = found.above - found.upper * flat.normal;
  const auto at = static_cast<std::size_t>(number - first_flat(body));
  bool within = false;
  if (body.is_curved()) {
    const double x = lane(found.below, 0), y = lane(found.below, 1);
    const double radius = body.curved.discs[at].radius;
    within = x * x + y * y <= radius * radius;
  } else {
    found.edge = crossed_side(body, body.facets[at], found.below);
    within = found.edge == kNone;
  }
  if (above || !within) found.end = within ? FlatEnd::kClosest : FlatEnd::kBeside;
  return found;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
