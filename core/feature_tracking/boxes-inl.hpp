// Boxes whose own axes are parallel. Gaps along the axes say which features face each other, and
// which displacement out of an overlap is the shortest. Compiled once per vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_BOXES) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_BOXES
#undef CLEARANCE_CORE_BOXES
#else
#define CLEARANCE_CORE_BOXES
#endif

#include "core/feature_tracking/pair-inl.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// Returns a bit mask of the axes of A's frame that are parallel to one of B's within rounding.
// `squares` has the squared elements of the rotation matrix.
HWY_INLINE unsigned shared_axes(const Diagonals& squares) {
  const Vec4 limit = spread(1.0 - 0x1p-46);
  return (less(limit, squares.main) | less(limit, squares.next) | less(limit, squares.last)) & 7u;
}
HWY_INLINE Diagonals squares_of(const Diagonals& m) {
  return {m.main * m.main, m.next * m.next, m.last * m.last};
}

inline constexpr FeatureKind kKindByAxes[8] = {
    FeatureKind::kUnknown, FeatureKind::kFacet, FeatureKind::kFacet, FeatureKind::kEdge,
    FeatureKind::kFacet,   FeatureKind::kEdge,  FeatureKind::kEdge,  FeatureKind::kVertex};

HWY_INLINE void to_farthest(const BoxFeatures& box, unsigned axes, unsigned negative, Side& side) {
  side.kind = kKindByAxes[axes];
  side.feature = box.farthest[axes | (negative & 7u) << 3];
}

// The axis of the greatest of three numbers, as a bit.
HWY_INLINE unsigned greatest_axis(Vec4 v) {
  const double x = lane(v, 0), y = lane(v, 1), z = lane(v, 2);
  return x >= y && x >= z ? 1u : y >= z ? 2u : 4u;
}

enum class Start {
  kNone,
  kDisjoint,
  kInContact,  // the bodies seem to touch along every axis
};

// If the gaps between two boxes lie along shared axes only, chooses the features that face each
// other. If the boxes overlap along all axes, chooses the facets across the axis of the least
// overlap. Otherwise returns kNone.
HWY_INLINE Start start_boxes(const Query4& q) {
  const BoxFeatures &a = q.a.box, &b = q.b.box;
  if (!a.exist() || !b.exist()) return Start::kNone;
  const Diagonals squares = squares_of(q.a_from_b.rotation);
  const unsigned shared = shared_axes(squares);
  const Vec4 between = point_to_a(q.a_from_b, load3_padded(b.centre)) - load3_padded(a.centre);
  const Vec4 zero = spread(0.0), up = where_less(between, zero, spread(-1.0), spread(1.0));
  const Vec4 gaps = up * between - (load3_padded(a.half) + squares * load3_padded(b.half));
  unsigned axes = less(zero, gaps) & 7u;
  if (axes == 0) axes = greatest_axis(gaps);
  if ((axes & ~shared) != 0 || (shared != 7u && axes != shared)) return Start::kNone;
  // The same axes in B's frame. B's features face the opposite side.
  const auto chosen = [axes](unsigned axis) { return (axes & axis) != 0 ? 1.0 : 0.0; };
  const Vec4 in_b = direction_to_b(q.a_from_b, vec4(chosen(1), chosen(2), chosen(4), 0.0) * up);
  to_farthest(a, axes, less(between, zero), q.state.a);
  to_farthest(b, less(spread(0.25), in_b * in_b) & 7u, less(zero, in_b), q.state.b);
  // The witness points of whole facets and edges will be halfway between these.
  q.state.a.point = a.centre;
  q.state.b.point = b.centre;
  const double size = q.a.bounding_radius + q.b.bounding_radius;
  const bool near = (less(gaps, spread(kMayTouch * size)) & 7u) == 7u;
  return near ? Start::kInContact : Start::kDisjoint;
}

HWY_INLINE Vec4 onto(const Facet& facet, Vec4 p) {
  const Vec4 n = load3_padded(facet.normal);
  return p - (dot(n, p) - facet.offset) * n;
}

// Clamps a point of a box's facet, in the box's frame, along the two axes of the facet.
HWY_INLINE Vec4 clamped_to_facet(const BoxFeatures& box, Vec4 n, Vec4 p) {
  const Vec4 centre = load3_padded(box.centre), half = load3_padded(box.half);
  const Vec4 low = centre - half, high = centre + half;
  const Vec4 within = where_less(high, p, high, where_less(p, low, low, p));
  return where_less(spread(0.5), n * n, p, within);
}

// Does what slide_back() does, by two clamps, for two boxes that share all axes. The first clamp is
// onto the facet of A, the second one onto that of B. Returns false if a body is no box, or if the
// boxes do not share all axes. Also returns false if the second clamp moves the point out of A's
// facet: the facets then do not face each other there.
inline HWY_NOINLINE bool slide_back_on_boxes(const ConvexBody& body_a, const ConvexBody& body_b,
                                             const RelativePose4& a_from_b, const Facet& facet_a,
                                             const Facet& facet_b, Vec4& local) {
  const BoxFeatures &a = body_a.box, &b = body_b.box;
  if (!a.exist() || !b.exist() || shared_axes(squares_of(a_from_b.rotation)) != 7u) return false;
  const Vec4 n = load3_padded(facet_a.normal);
  const Vec4 on_a = clamped_to_facet(a, n, point_to_a(a_from_b, local));
  const Vec4 on_b =
      clamped_to_facet(b, load3_padded(facet_b.normal), onto(facet_b, point_to_b(a_from_b, on_a)));
  const Vec4 again = point_to_a(a_from_b, on_b);
  const Vec4 off = again - clamped_to_facet(a, n, again);
  const double rounding = 0x1p-50 * (body_a.bounding_radius + body_b.bounding_radius);
  local = on_b;
  return dot(off, off) <= rounding * rounding;
}

// A margin far above rounding, as a part of the pair's size. The test only has to show whether
// other directions are longer by this margin.
inline constexpr double kAmple = 1e-9;

HWY_INLINE bool are_facets_of_boxes(const TrackedPair& pair) {
  return pair.features() == FeaturePair::kFacetFacet && pair.a.box.exist() && pair.b.box.exist();
}

// Is the displacement along every other direction longer? A - B is a prism over a polygon whose
// sides are across the boxes' other axes. So the displacement is the shortest if those along these
// axes and past the opposite facets are longer.
inline HWY_NOINLINE bool is_shortest_of_boxes(const TrackedPair& pair, double size) {
  const BoxFeatures &a = pair.a.box, &b = pair.b.box;
  const auto magnitude = [](Vec4 v) HWY_ATTR { return where_less(v, spread(0.0), -v, v); };
  const auto magnitudes = [&](const Diagonals& m) HWY_ATTR {
    return Diagonals{magnitude(m.main), magnitude(m.next), magnitude(m.last)};
  };
  const Diagonals to_a = magnitudes(pair.a_from_b.rotation);
  const Diagonals to_b = magnitudes(pair.a_from_b.transposed);
  const Vec4 half_a = load3_padded(a.half), half_b = load3_padded(b.half);
  const Vec4 between = point_to_a(pair.a_from_b, load3_padded(b.centre)) - load3_padded(a.centre);
  const Vec4 gaps_a = magnitude(between) - (half_a + to_a * half_b);
  const Vec4 gaps_b = magnitude(direction_to_b(pair.a_from_b, between)) - (half_b + to_b * half_a);
  const auto all_others_longer = [&](Vec4 gaps, const Facet& facet) HWY_ATTR {
    const Vec4 n = load3_padded(facet.normal), limit = spread(pair.found.distance - kAmple * size);
    return ((less(gaps, limit) | less(spread(0.5), n * n)) & 7u) == 7u;
  };
  const Vec4 n = load3_padded(pair.a.facets[pair.on_a.feature].normal);
  return dot(n, between) > kAmple * size &&
         all_others_longer(gaps_a, pair.a.facets[pair.on_a.feature]) &&
         all_others_longer(gaps_b, pair.b.facets[pair.on_b.feature]);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
