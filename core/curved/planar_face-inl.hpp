// A planar face of a body (facet or cap) and the other body's point that is nearest to its plane.
// Compiled once a vector width: see core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_PLANAR_FACE) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_PLANAR_FACE
#undef CLEARANCE_CORE_PLANAR_FACE
#else
#define CLEARANCE_CORE_PLANAR_FACE
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/body_support-inl.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

struct PlanarFace {
  Vec4 normal;  // outward, unit
  double offset;
};
HWY_INLINE PlanarFace planar_face(const Side& side, std::int32_t number) {
  const auto at = static_cast<std::size_t>(number - first_planar_face(side.body));
  if (side.is_round()) {
    const double up = at == 0 ? -1.0 : 1.0;
    return {vec4(0.0, 0.0, up, 0.0), up * side.round.parts[at].height};
  }
  const Facet& facet = side.body.facets[at];
  return {load3(facet.normal), facet.offset};
}

// The number of the facet that has all three active vertices; kNone: there is none.
inline HWY_NOINLINE std::int32_t facet_of(const ConvexBody& body, const SideParts& active) {
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
      if (is_on(vertex(1)) && is_on(vertex(2))) return first_planar_face(body) + facet;
    }
  }
  return kNone;
}

enum class FaceEnd { kClosest, kBeside, kUnknown };

struct FaceMeeting {
  FaceEnd end = FaceEnd::kUnknown;
  double lower, upper;  // the distance of the other body from the face's plane
  // The other body's nearest point, in its own frame and in the face's frame, and its projection
  // onto the face.
  Vec4 on_other, above, below;
  std::int32_t part;          // of the other body
  std::int32_t edge = kNone;  // the nearest point lies past this edge of a facet
};

// Does the other body's nearest point lie above the face? `number`: that of the face, which is A's
// if kOfA. `part`: the nearest part of the other body, as far as it is known.
template <bool kOfA>
HWY_INLINE FaceMeeting meet_face(const Side& side, const Side& other, const RelativePose4& a_from_b,
                                 std::int32_t number, std::int32_t part) {
  const PlanarFace face = planar_face(side, number);
  const Vec4 down =
      -(kOfA ? direction_to_b(a_from_b, face.normal) : direction_to_a(a_from_b, face.normal));
  FaceMeeting found;
  PartPair pair{part, part};
  const double whole = 1.0;
  const SideParts one{&pair, &whole, 1, &PartPair::a};
  BodySupport nearest = body_support(other, one, down);
  if (nearest.missing != kNone) {
    pair.a = nearest.missing;
    nearest = body_support(other, one, down);
  }
  if (!nearest.known || nearest.missing != kNone) return found;
  found.part = pair.a;
  found.on_other = nearest.point;
  found.above = kOfA ? point_to_a(a_from_b, nearest.point) : point_to_b(a_from_b, nearest.point);
  found.upper = dot(face.normal, found.above) - face.offset;
  found.lower = found.upper - std::max(0.0, nearest.value - dot(down, nearest.point));
  const bool above = found.lower > 0.0;
  if (!above && !side.is_round()) return found;
  found.below = found.above - found.upper * face.normal;
  const auto at = static_cast<std::size_t>(number - first_planar_face(side.body));
  bool within = false;
  if (side.is_round()) {
    const double x = lane(found.below, 0), y = lane(found.below, 1);
    const double radius = side.round.parts[at].radius;
    within = x * x + y * y <= radius * radius;
  } else {
    found.edge = crossed_side(side.body, side.body.facets[at], found.below);
    within = found.edge == kNone;
  }
  if (above || !within) found.end = within ? FaceEnd::kClosest : FaceEnd::kBeside;
  return found;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
