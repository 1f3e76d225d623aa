// A planar face of a body (facet or cap) and the other body's point that is nearest to its plane.
// Compiled once per vector width: see core/numerics/vec4-inl.hpp.
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

struct FaceProjection {
  FaceEnd end = FaceEnd::kUnknown;
  double lower, upper;  // the distance of the other body from the face's plane
  // The other body's nearest point, in its own frame and in the face's frame, and its projection
  // onto the face.
  Vec4 on_other, above, below;
  std::int32_t part;          // of the other body
  std::int32_t edge = kNone;  // the nearest point lies past this edge of a facet
};

// Points of a body that have its greatest support value, up to rounding. The first one is the
// support point of `part`. The others are likely to lie over a face that is parallel to the body
// there.
struct SupportSet {
  bool known = false;
  double value = 0.0;
  std::int32_t part = kNone;
  Vec4 points[4];
  int count = 0;

  HWY_INLINE void add(Vec4 point) {
    if (count < 4) points[count++] = point;
  }
};

// Any point of the middle of a face, in the face's frame.
HWY_INLINE Vec4 middle_of_face(const Side& side, std::int32_t number) {
  const auto at = static_cast<std::size_t>(number - first_planar_face(side.body));
  if (side.is_round()) return vec4(0.0, 0.0, side.round.parts[at].height, 0.0);
  const Facet& facet = side.body.facets[at];
  Vec4 sum = spread(0.0);
  for (std::int32_t i = 0; i < facet.sides; ++i) {
    const EdgeUse& use = side.body.facet_edges[static_cast<std::size_t>(facet.first_side + i)];
    const Edge& edge = side.body.edges[static_cast<std::size_t>(use.edge)];
    sum = sum + load3(side.body.vertices[static_cast<std::size_t>(edge.vertex[use.side])].position);
  }
  return over(sum, facet.sides);
}

// m: unit; `middle`: a point that the other points should be near to.
HWY_INLINE SupportSet round_support_set(const Side& side, Vec4 m, Vec4 middle, double tolerance) {
  const Vec4 semi_axes = side.semi_axes(), scaled = semi_axes * m;
  const double length = norm(scaled);
  SupportSet found;
  found.known = true;
  if (side.round.count == 1) {
    found.value = length;
    found.part = 0;
    found.add(over(semi_axes * scaled, length));
    return found;
  }
  const SupportPart largest = support_part(side.round, lane(m, 2), length);
  const Disc *const discs = side.round.parts, &disc = discs[largest.number];
  found.value = largest.value;
  found.part = largest.number;
  const Vec4 outwards = length > 0.0 ? over(scaled, length) : vec4(1.0, 0.0, 0.0, 0.0);
  const auto rim_point = [&](const Disc& of) HWY_ATTR {
    return of.radius * outwards + vec4(0.0, 0.0, of.height, 0.0);
  };
  found.add(rim_point(disc));
  if (HWY_UNLIKELY(disc.radius * length <= tolerance)) {
    const Vec4 centre = vec4(0.0, 0.0, disc.height, 0.0);
    const Vec4 across = vec4(lane(middle, 0), lane(middle, 1), 0.0, 0.0);
    found.add(centre);
    found.add(centre + std::min(1.0, disc.radius / norm(across)) * across);
    return found;
  }
  const Disc& beside = discs[1 - largest.number];
  const double value = beside.height * lane(m, 2) + beside.radius * length;
  if (HWY_UNLIKELY(largest.value - value <= tolerance)) {
    found.add(rim_point(beside));
    found.add(0.5 * (found.points[0] + found.points[1]));
  }
  return found;
}
// `part`: a vertex to begin with.
HWY_INLINE SupportSet vertex_support_set(const ConvexBody& body, Vec4 m, Vec4 middle,
                                         std::int32_t part, double tolerance) {
  PartPair pair{part, part};
  const double whole = 1.0;
  const SideParts one{&pair, &whole, 1, &PartPair::a};
  BodySupport nearest = polyhedron_support(body, one, m);
  if (nearest.missing != kNone) {
    pair.a = nearest.missing;
    nearest = polyhedron_support(body, one, m);
  }
  SupportSet found;
  if (nearest.missing != kNone) return found;
  found.known = true;
  found.value = nearest.value;
  found.part = pair.a;
  found.add(nearest.point);
  const Vertex& vertex = body.vertices[static_cast<std::size_t>(pair.a)];
  for (std::int32_t i = 0; i < vertex.edges; ++i) {
    const std::int32_t end = body.neighbours[static_cast<std::size_t>(vertex.first_edge + i)];
    if (end == kNone) continue;
    const Vec4 along = load3(body.vertices[static_cast<std::size_t>(end)].position) - nearest.point;
    if (HWY_LIKELY(dot(m, along) < -tolerance)) continue;
    const double part_of_edge = dot(along, middle - nearest.point) / dot(along, along);
    found.add(nearest.point + std::clamp(part_of_edge, 0.0, 1.0) * along);
  }
  return found;
}

// The edge of a facet past which a point of its plane lies; kNone: it lies within.
HWY_INLINE bool is_within(const Side& side, std::int32_t number, Vec4 point, std::int32_t& edge) {
  const auto at = static_cast<std::size_t>(number - first_planar_face(side.body));
  if (side.is_round()) {
    const double x = lane(point, 0), y = lane(point, 1), radius = side.round.parts[at].radius;
    return x * x + y * y <= radius * radius;
  }
  edge = crossed_side(side.body, side.body.facets[at], point);
  return edge == kNone;
}

// Does a point of the other body that is nearest to the face's plane lie above the face? `number`:
// that of the face, which is A's if kOfA. `part`: the nearest part of the other body, as far as it
// is known. `tolerance`: points whose distances from the plane differ by less are equally near, m.
template <bool kOfA>
HWY_INLINE FaceProjection project_on_face(const Side& side, const Side& other,
                                          const RelativePose4& a_from_b, std::int32_t number,
                                          std::int32_t part, double tolerance) {
  const PlanarFace face = planar_face(side, number);
  const Vec4 down =
      -(kOfA ? direction_to_b(a_from_b, face.normal) : direction_to_a(a_from_b, face.normal));
  const Vec4 in_face = middle_of_face(side, number);
  const Vec4 middle = kOfA ? point_to_b(a_from_b, in_face) : point_to_a(a_from_b, in_face);
  const SupportSet nearest = other.is_round()
                                 ? round_support_set(other, down, middle, tolerance)
                                 : vertex_support_set(other.body, down, middle, part, tolerance);
  FaceProjection found;
  if (!nearest.known) return found;
  found.part = nearest.part;
  for (int i = 0; i < nearest.count; ++i) {
    FaceProjection at = found;
    at.on_other = nearest.points[i];
    at.above = kOfA ? point_to_a(a_from_b, at.on_other) : point_to_b(a_from_b, at.on_other);
    at.upper = dot(face.normal, at.above) - face.offset;
    at.lower = at.upper - std::max(0.0, nearest.value - dot(down, at.on_other));
    const bool above = at.lower > 0.0;
    if (!above && !side.is_round()) return i == 0 ? at : found;
    at.below = at.above - at.upper * face.normal;
    const bool within = is_within(side, number, at.below, at.edge);
    if (above || !within) at.end = within ? FaceEnd::kClosest : FaceEnd::kBeside;
    if (i == 0 || at.end == FaceEnd::kClosest) found = at;
    if (at.end != FaceEnd::kBeside) return found;
  }
  return found;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
