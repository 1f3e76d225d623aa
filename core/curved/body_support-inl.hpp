// The support value of a whole body along a direction and the support point of its active parts, in
// the body's frame. A certificate needs both. Compiled once per vector width: see
// core/numerics/vec4-inl.hpp.
#if defined(CLEARANCE_CORE_BODY_SUPPORT) == defined(HWY_TARGET_TOGGLE)
#ifdef CLEARANCE_CORE_BODY_SUPPORT
#undef CLEARANCE_CORE_BODY_SUPPORT
#else
#define CLEARANCE_CORE_BODY_SUPPORT
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/curved/body_view.hpp"
#include "core/model/edge_scan-inl.hpp"
#include "core/model/support_function.hpp"
#include "core/numerics/error_constants.hpp"

HWY_BEFORE_NAMESPACE();
namespace clearance::HWY_NAMESPACE {

// A body as Newton's method sees it.
struct Side {
  const ConvexBody& body;
  RoundParts round;  // no parts: a polyhedron

  [[nodiscard]] HWY_INLINE bool is_round() const { return round.parts != nullptr; }
  // D.
  [[nodiscard]] HWY_INLINE Vec4 semi_axes() const { return load3(round.semi_axes); }
};
HWY_INLINE Side side_of(const ConvexBody& body) {
  if (!body.is_curved()) return {body, BodyDefaults().round_parts()};
  return {body, visit(body.curved, [](const auto& shape) { return shape.round_parts(); })};
}

// The active parts of one body and their weights, of sum 1.
struct SideParts {
  const PartPair* pairs;
  const double* weight;
  std::size_t count;
  std::int32_t PartPair::*side;

  [[nodiscard]] HWY_INLINE std::int32_t number(std::size_t i) const { return pairs[i].*side; }
  [[nodiscard]] HWY_INLINE bool has(std::int32_t part) const {
    for (std::size_t i = 0; i < count; ++i) {
      if (number(i) == part) return true;
    }
    return false;
  }
};

struct BodySupport {
  bool known = false;            // false: the other members have no meaning
  std::int32_t missing = kNone;  // a part whose support value is at least that of the active ones
  std::int32_t part = kNone;     // the part with the greatest support value that is known
  double value = 0.0;            // the support value of the body without its radius
  Vec4 point{};                  // the mean of the active parts' support points
};

// For directions nearer to the axis of a truncated cone than this, a cap is tried.
inline constexpr double kNearAxis = 0x1p-20;

// The part of the greatest support value, height m_z + radius |D m|, and that value.
struct SupportPart {
  std::int32_t number;
  double value;
};
HWY_INLINE SupportPart support_part(const RoundParts& round, double m_z, double length) {
  SupportPart found{0, round.parts[0].height * m_z + round.parts[0].radius * length};
  for (std::int32_t i = 1; i < round.count; ++i) {
    const double value = round.parts[i].height * m_z + round.parts[i].radius * length;
    if (value > found.value) found = {i, value};
  }
  return found;
}

HWY_INLINE BodySupport round_support(const Side& side, const SideParts& active, Vec4 m) {
  const Vec4 semi_axes = side.semi_axes(), scaled = semi_axes * m;
  const double length = norm(scaled);
  if (side.round.count == 1) return {true, kNone, 0, length, over(semi_axes * scaled, length)};
  if (side.round.has_caps && HWY_UNLIKELY(!(length > kNearAxis))) return BodySupport();
  const SupportPart largest = support_part(side.round, lane(m, 2), length);
  BodySupport found;
  found.known = true;
  found.value = largest.value;
  found.part = largest.number;
  if (!active.has(largest.number)) found.missing = largest.number;
  double radius = 0.0, height = 0.0;
  for (std::size_t i = 0; i < active.count; ++i) {
    const Disc& part = side.round.parts[active.number(i)];
    radius += active.weight[i] * part.radius;
    height += active.weight[i] * part.height;
  }
  found.point = over(radius * (semi_axes * scaled), length) + vec4(0.0, 0.0, height, 0.0);
  return found;
}

// Considers the edges from a vertex to others that are not active and do not recede by more than
// rounding. Returns the greatest directional derivative of these edges along m; -infinity: there
// are none.
HWY_INLINE double ascent(const ConvexBody& body, std::int32_t number, const SideParts& active,
                         Vec4 m) {
  const Vertex& vertex = body.vertices[static_cast<std::size_t>(number)];
  const double* four = body.outgoing.row(vertex.first_edge);
  const Spread3 along(m);
  double steepest = -kInfinity;
  for (std::int32_t i = 0; i < vertex.edges; i += 4, four += kFourDirections) {
    const Vec4 all = derivatives(four, along);
    unsigned others = at_least(all, spread(-kDerivativeError));
    for (; HWY_UNLIKELY(others != 0); others &= others - 1) {
      const int k = std::countr_zero(others);
      if (active.has(body.neighbours[static_cast<std::size_t>(vertex.first_edge + i + k)]))
        continue;
      steepest = std::max(steepest, lane(all, k));
    }
  }
  return steepest;
}

// Consider all edges of the active vertices, except those that join two of them. If all recede, the
// support vertex is the active vertex with the greatest m.x. This is the vertex test of feature
// tracking (Lin and Canny 1991).
HWY_INLINE BodySupport polyhedron_support(const ConvexBody& body, const SideParts& active, Vec4 m) {
  BodySupport found;
  found.known = true;
  found.value = -kInfinity;
  found.point = spread(0.0);
  double steepest = -kInfinity;
  for (std::size_t i = 0; i < active.count; ++i) {
    const Vec4 p = load3(body.anchors[static_cast<std::size_t>(active.number(i))]);
    found.point = found.point + active.weight[i] * p;
    const double value = dot(m, p);
    if (value > found.value) found.part = active.number(i);
    found.value = std::max(found.value, value);
    steepest = std::max(steepest, ascent(body, active.number(i), active, m));
  }
  if (HWY_LIKELY(!(steepest > -kInfinity))) return found;
  const Support whole = support(body, vec3(m));
  if (steepest > 4.0 * kDerivativeError && !active.has(whole.anchor)) {
    found.missing = found.part = whole.anchor;
  }
  found.value = std::max(found.value, whole.value);
  return found;
}

// The part with the greatest support value along m (unit), and that value.
HWY_INLINE SupportPart support_part(const Side& side, const SideParts& active, Vec4 m) {
  if (side.is_round()) {
    const double length = norm(side.semi_axes() * m);
    if (side.round.count == 1) return {0, length};
    return support_part(side.round, lane(m, 2), length);
  }
  const BodySupport found = polyhedron_support(side.body, active, m);
  return {found.part, found.value};
}

HWY_INLINE BodySupport body_support(const Side& side, const SideParts& active, Vec4 m) {
  return side.is_round() ? round_support(side, active, m)
                         : polyhedron_support(side.body, active, m);
}

}  // namespace clearance::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
