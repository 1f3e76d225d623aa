// A point or a segment, and a truncated cone: a sphere or a capsule beside a cylinder or a cone, or
// a sphere whose centre is inside.
// Compiled once per vector width: see core/numerics/vec4-inl.hpp.
//
// In the half-plane through a point that the axis bounds, the truncated cone is a trapezoid. The
// point is beside a cap, the side or a rim, and this gives the closest point and the normal without
// iteration.
//
// Along a segment the distance is a convex function. Its derivative is the normal's component along
// the segment. The point nearest to the axis is tried first: it is closest if it lies beside a
// cylinder's side. Otherwise the derivative there names the end that may be closest. A point within
// the segment that is closest to a rim has no closed form and is left to Newton's method. So is
// what rounding leaves open, and the thorough effort answers bodies that meet.
#if defined(CLEARANCE_CORE_SEGMENT_AND_CONE) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_SEGMENT_AND_CONE
#undef CLEARANCE_CORE_SEGMENT_AND_CONE
#else
#define CLEARANCE_CORE_SEGMENT_AND_CONE
#endif

#include <algorithm>
#include <cmath>

#include "core/curved/bounds.hpp"
#include "core/curved/tracking.hpp"
#include "core/model/relative_pose-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

HWY_INLINE bool are_segment_and_cone(const ConvexBody& segment, const ConvexBody& cone) {
  return segment.is_thin() && cone.curved.kind == CurvedShape::Kind::kTruncatedCone;
}

// In the half-plane: the distance from the axis, and the height.
struct Section {
  double across, height;
};
HWY_INLINE double dot(const Section& u, const Section& v) {
  return u.across * v.across + u.height * v.height;
}

// The closest point of the trapezoid and the normal there (unit).
struct SectionPoint {
  Section closest, normal;
};
HWY_INLINE SectionPoint nearest_on_section(const std::array<Disc, 2>& discs, const Section& p) {
  const auto& [low, high] = discs;
  if (p.height > high.height && p.across <= high.radius) {
    return {{p.across, high.height}, {0.0, 1.0}};
  }
  if (p.height < low.height && p.across <= low.radius) {
    return {{p.across, low.height}, {0.0, -1.0}};
  }
  const Section side{high.radius - low.radius, high.height - low.height};
  const Section out{p.across - low.radius, p.height - low.height};
  const double along = dot(out, side), square = dot(side, side);
  if (along > 0.0 && along < square) {
    if (side.across == 0.0) return {{low.radius, p.height}, {1.0, 0.0}};
    const double s = along / square, inverse = 1.0 / std::sqrt(square);
    return {{low.radius + s * side.across, low.height + s * side.height},
            {inverse * side.height, -inverse * side.across}};
  }
  const Disc& rim = along > 0.0 ? high : low;
  const Section from{p.across - rim.radius, p.height - rim.height};
  const double inverse = 1.0 / std::sqrt(dot(from, from));
  return {{rim.radius, rim.height}, {inverse * from.across, inverse * from.height}};
}

// The same for a point inside.
HWY_INLINE SectionPoint nearest_from_inside(const std::array<Disc, 2>& discs, const Section& p) {
  const auto& [low, high] = discs;
  const Section side{high.radius - low.radius, high.height - low.height};
  const double inverse = 1.0 / std::sqrt(dot(side, side));
  const Section out{inverse * side.height, -inverse * side.across};
  const double beyond = dot(out, {p.across - low.radius, p.height - low.height});
  const double above = p.height - high.height, below = low.height - p.height;
  if (beyond >= std::max(above, below)) {
    return {{p.across - beyond * out.across, p.height - beyond * out.height}, out};
  }
  return above >= below ? SectionPoint{{p.across, high.height}, {0.0, 1.0}}
                        : SectionPoint{{p.across, low.height}, {0.0, -1.0}};
}

// A point in the cone's frame, and the closest point of the cone.
struct ConePoint {
  HWY_INLINE ConePoint(const std::array<Disc, 2>& discs, Vec4 place, bool is_inside = false)
      : placed(place),
        p{across_axis(place), lane(place, 2)},
        section(is_inside ? nearest_from_inside(discs, p) : nearest_on_section(discs, p)) {
    const auto& [closest, normal] = section;
    const bool over_cap = normal.across == 0.0;  // there the point may be on the axis
    const double part = over_cap ? 1.0 : closest.across / p.across;
    const double scale = over_cap ? 0.0 : normal.across / p.across;
    const double x = lane(place, 0), y = lane(place, 1);
    on_cone = vec4(part * x, part * y, closest.height, 0.0);
    outward = vec4(scale * x, scale * y, normal.height, 0.0);
  }
  // The distance of the point beyond the cone along the normal, m; below 0 inside.
  HWY_INLINE double along_normal(const std::array<Disc, 2>& discs) const {
    const Section& n = section.normal;
    const auto support = [&](const Disc& disc) HWY_ATTR {
      return dot(n, {disc.radius, disc.height});
    };
    return dot(n, p) - std::max(support(discs[0]), support(discs[1]));
  }
  static HWY_INLINE double across_axis(Vec4 v) {
    return std::sqrt(lane(v, 0) * lane(v, 0) + lane(v, 1) * lane(v, 1));
  }

  Vec4 placed;
  Section p;
  SectionPoint section;
  Vec4 on_cone, outward;  // the closest point, and the normal there (unit)
};

// Roundings besides those of rounding_error(), in ulps of the segment's largest distance from the
// cone's origin: 5 to place a point there, 2 for its distance from the axis, 3.5 for the length of
// the normal, 3 for their product, and 16 for the normal's component along the segment. If the cone
// is B, the rotation's error moves the segment as well.
inline constexpr double kUlpsOfPlacedSegment = 30;
// For the normal of a side that is nearest to a point inside, in ulps of the cone's bounding
// radius. Its direction is off by 1, which twice that radius multiplies. The product has 3, and 3
// are to spare.
inline constexpr double kUlpsOfSide = 8;
// Nearer to the axis, the square of the distance from it loses digits, m.
inline constexpr double kBesideAxis = 1e-100;
// Derivatives below this are 0 within rounding.
inline constexpr double kLevelSlope = 0x1p-49;

// `kConeIsA`: else the segment is A.
template <bool kConeIsA>
HWY_INLINE bool segment_and_cone_distance(const ConvexBody& a, const ConvexBody& b,
                                          const RelativePose4& a_from_b, TrackingState& state,
                                          DistanceResult& r) {
  const ConvexBody &cone = kConeIsA ? a : b, &segment = kConeIsA ? b : a;
  const std::array<Disc, 2>& discs = cone.curved.discs;
  const Vec4 start = load3_masked(segment.vertices[0].position);
  const Vec4 placed = kConeIsA ? point_to_a(a_from_b, start) : point_to_b(a_from_b, start);
  Vec4 local = start;
  ConePoint nearest(discs, placed);
  double behind = 0.0;  // m: an end of the segment is nearer along the normal by this
  if (!is_point(segment)) {
    const Edge& edge = segment.edges[0];
    const Vec4 direction = load3_padded(edge.direction);
    const Vec4 e =
        kConeIsA ? direction_to_a(a_from_b, direction) : direction_to_b(a_from_b, direction);
    const double x = lane(e, 0), y = lane(e, 1), across = x * x + y * y;
    const double to_axis = -(lane(placed, 0) * x + lane(placed, 1) * y);
    double s = to_axis > 0.0 ? (to_axis < across * edge.end ? to_axis / across : edge.end) : 0.0;
    if (s > 0.0) nearest = ConePoint(discs, placed + s * e);
    double slope = dot(nearest.outward, e);
    if (slope > kLevelSlope && s > 0.0) {
      s = 0.0;
      nearest = ConePoint(discs, placed);
      slope = dot(nearest.outward, e);
      if (slope < -kLevelSlope) return false;
    } else if (slope < -kLevelSlope && s < edge.end) {
      s = edge.end;
      nearest = ConePoint(discs, placed + s * e);
      slope = dot(nearest.outward, e);
      if (slope > kLevelSlope) return false;
    }
    behind = std::max(0.0, std::max(s * slope, (s - edge.end) * slope));
    local = start + s * direction;
  }
  const auto& [closest, normal] = nearest.section;
  const Section gap{nearest.p.across - closest.across, nearest.p.height - closest.height};
  const double offset = a_from_b.translation_length;
  const double size = size_of(a, b, offset);
  CurvedConclusion found{};
  found.lower = nearest.along_normal(discs) - behind;
  found.upper = std::sqrt(dot(gap, gap));
  const bool known =
      found.lower > 0.0 && normal.across >= 0.0 && found.upper - found.lower <= 0x1p-50 * size;
  const bool may_be_inside = !known && is_point(segment) && nearest.p.across > kBesideAxis;
  if (HWY_UNLIKELY(may_be_inside)) {
    nearest = ConePoint(discs, placed, true);
    found.lower = found.upper = nearest.along_normal(discs);
  }
  found.error =
      rounding_error({&a, a.bounding_radius}, {&b, b.bounding_radius}, place_of(a_from_b),
                     found.upper, size) +
      (kUlpsOfPlacedSegment * kUlp + (kConeIsA ? 0.0 : kRoundedUp * a_from_b.rotation_error)) *
          (segment.bounding_radius + offset) +
      (may_be_inside ? kUlpsOfSide * kUlp * cone.bounding_radius : 0.0);
  // Demands a depth beyond the error: near a rim or an apex, a point outside may be farther from
  // the cone than from each plane.
  const bool is_inside = may_be_inside && found.upper < -2.0 * found.error;
  if (HWY_UNLIKELY(!known && !is_inside)) return false;
  found.size = size;
  if constexpr (kConeIsA) {
    found.normal = vec3(nearest.outward);
    found.point_on_a = vec3(nearest.on_cone);
    found.point_on_b = vec3(nearest.placed);
  } else {
    const Vec4 inward = -direction_to_a(a_from_b, nearest.outward);
    found.normal = vec3((1.5 - 0.5 * dot(inward, inward)) * inward);
    found.point_on_a = vec3(local);
    found.point_on_b = vec3(point_to_a(a_from_b, nearest.on_cone));
  }
  found.is_radial = true;
  r = conclude(a, b, found);
  r.iterations = 1;
  state.a = {FeatureKind::kDirection, false, 0, found.normal};
  state.b = {FeatureKind::kDirection, false, 0, vec3(kConeIsA ? local : nearest.on_cone)};
  return true;
}

// Answers a point or a segment beside a truncated cone. False: it is another pair, or it is left
// open.
HWY_INLINE bool segment_and_cone_distance(const ConvexBody& a, const ConvexBody& b,
                                          const RelativePose4& a_from_b, TrackingState& state,
                                          DistanceResult& r) {
  if (are_segment_and_cone(b, a)) return segment_and_cone_distance<true>(a, b, a_from_b, state, r);
  if (are_segment_and_cone(a, b)) return segment_and_cone_distance<false>(a, b, a_from_b, state, r);
  return false;
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
