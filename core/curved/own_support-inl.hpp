// How far a whole body reaches along a direction, in its own frame, and where the pieces that are
// thought to be active do: what a certificate takes. Compiled once a vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_OWN_SUPPORT) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_OWN_SUPPORT
#undef CLEARANCE_CORE_OWN_SUPPORT
#else
#define CLEARANCE_CORE_OWN_SUPPORT
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/curved/active_pieces.hpp"
#include "core/model/edge_scan-inl.hpp"
#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// The active pieces of one of the bodies and their weights, of sum 1.
struct SidePieces {
  const PiecePair* pieces;
  const double* weight;
  std::size_t count;
  std::int32_t PiecePair::*side;

  [[nodiscard]] HWY_INLINE std::int32_t number(std::size_t i) const { return pieces[i].*side; }
  [[nodiscard]] HWY_INLINE bool has(std::int32_t piece) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (number(i) == piece) return true;
    }
    return false;
  }
};

struct OwnSupport {
  bool known = false;            // false: the rest is not
  std::int32_t missing = kNone;  // a piece that reaches farther than the active ones, or as far
  // Of the body without its radius; of a polyhedron that misses a piece, of the active ones.
  double reach = 0.0;
  Vec4 point{};  // the mean of the active pieces' support points
};

// Nearer to the axis of a truncated cone than this, which way a direction leans counts for little.
inline constexpr double kNearAxis = 0x1p-20;

HWY_INLINE OwnSupport ellipsoid_support(const CurvedShape& shape, Vec4 m) {
  const Vec4 semi_axes = load3(shape.semi_axes), scaled = semi_axes * m;
  OwnSupport found;
  found.known = true;
  found.reach = norm(scaled);
  found.point = over(semi_axes * scaled, found.reach);
  return found;
}

HWY_INLINE OwnSupport cone_support(const CurvedShape& shape, const SidePieces& active, Vec4 m) {
  const double x = lane(m, 0), y = lane(m, 1), z = lane(m, 2), across = std::sqrt(x * x + y * y);
  if (HWY_UNLIKELY(!(across > kNearAxis))) return OwnSupport();
  const auto& [low, high] = shape.discs;
  const double at_low = low.height * z + low.radius * across;
  const double at_high = high.height * z + high.radius * across;
  OwnSupport found;
  found.known = true;
  found.reach = std::max(at_low, at_high);
  const std::int32_t farthest = at_high > at_low ? 1 : 0;
  if (!active.has(farthest)) found.missing = farthest;
  double radius = 0.0, height = 0.0;
  for (std::size_t i = 0; i < active.count; ++i) {
    const Disc& disc = shape.discs[static_cast<std::size_t>(active.number(i))];
    radius += active.weight[i] * disc.radius;
    height += active.weight[i] * disc.height;
  }
  const double part = radius / across;
  found.point = vec4(part * x, part * y, height, 0.0);
  return found;
}

// Does a neighbour of `vertex` that is not active reach farther than it along m, or as far but for
// rounding? kNone: none does.
struct Ascent {
  std::int32_t to = kNone;
  double derivative = -kInfinity;
};
HWY_INLINE Ascent ascent(const ConvexBody& body, std::int32_t number, const SidePieces& active,
                         Vec4 m) {
  const Vertex& vertex = body.vertices[static_cast<std::size_t>(number)];
  const double* row = body.outgoing.row(vertex.first_edge);
  const Vec4 along[3] = {spread(lane(m, 0)), spread(lane(m, 1)), spread(lane(m, 2))};
  Ascent found;
  for (std::int32_t i = 0; i < vertex.edges; i += 4) {
    const Vec4 all = derivatives(row, vertex.edges, i, along);
    unsigned others = ~less(all, spread(-kDerivativeError)) & first_lanes(vertex.edges - i);
    for (; HWY_UNLIKELY(others != 0); others &= others - 1) {
      const int k = std::countr_zero(others);
      const std::int32_t to = body.neighbours[static_cast<std::size_t>(vertex.first_edge + i + k)];
      if (active.has(to) || !(lane(all, k) > found.derivative)) continue;
      found = {to, lane(all, k)};
    }
  }
  return found;
}

// From a vertex up to where no edge leads farther along m.
inline HWY_NOINLINE std::int32_t climbed(const ConvexBody& body, std::int32_t from, const Vec3& m) {
  for (std::size_t step = 0; step < body.vertices.size(); ++step) {
    const Vertex& vertex = body.vertices[static_cast<std::size_t>(from)];
    const SteepestEdge next = steepest(body, vertex, m);
    if (!(next.derivative > kDerivativeError)) break;
    from = body.neighbours[static_cast<std::size_t>(next.at)];
  }
  return from;
}

// Where all edges of all active vertices recede that do not join two of these, the farthest of them
// is the support vertex: the edges that join them cannot lead farther than it, but for rounding.
HWY_INLINE OwnSupport polyhedron_support(const ConvexBody& body, const SidePieces& active, Vec4 m) {
  OwnSupport found;
  found.known = true;
  found.reach = -kInfinity;
  found.point = spread(0.0);
  Ascent steepest_one;
  std::int32_t from = kNone;
  for (std::size_t i = 0; i < active.count; ++i) {
    const Vec4 p = load3(body.anchors[static_cast<std::size_t>(active.number(i))]);
    found.point = found.point + active.weight[i] * p;
    found.reach = std::max(found.reach, dot(m, p));
    const Ascent one = ascent(body, active.number(i), active, m);
    if (one.derivative > steepest_one.derivative) {
      steepest_one = one;
      from = active.number(i);
    }
  }
  if (HWY_LIKELY(from == kNone)) return found;
  if (steepest_one.derivative > 4.0 * kDerivativeError) {
    found.missing = climbed(body, steepest_one.to, vec3(m));
    if (!active.has(found.missing)) return found;
    found.missing = kNone;
  }
  found.reach = std::max(found.reach, support(body, vec3(m)).value);
  return found;
}

HWY_INLINE OwnSupport own_support(const ConvexBody& body, const SidePieces& active, Vec4 m) {
  switch (body.curved.kind) {
    case CurvedShape::Kind::kNone:
      return polyhedron_support(body, active, m);
    case CurvedShape::Kind::kEllipsoid:
      return ellipsoid_support(body.curved, m);
    case CurvedShape::Kind::kTruncatedCone:
      break;
  }
  return cone_support(body.curved, active, m);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
