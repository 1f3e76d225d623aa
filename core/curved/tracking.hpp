// The state of a pair with a curved body between queries, and how a TrackingState holds it.
#pragma once

#include <cmath>

#include "core/curved/body_view.hpp"
#include "core/model/query.hpp"

namespace clearance {

// Do the bodies seem to overlap? Then `normal` is the direction from which the depth is searched.
enum class Overlap : std::uint8_t {
  kNo,
  kLastQuery,
  kStationary,  // Newton's method has ended at an overlap
  kNoDepth,     // no depth was found from there
};

// A hint and never a fact.
struct CurvedTrackingState {
  Vec3 normal = Vec3::Zero();  // frame A, of about unit length; 0: none
  ActiveParts active;          // pairs of parts; or one pair with a planar face in place of a part
  Vec3 point_on_b_B = Vec3::Zero();  // the last witness point on B without its radius, frame B
  Overlap overlap = Overlap::kNo;
};

// Drops features that the bodies do not have, more than one planar face, and a face among several
// pairs.
inline void forget_nonsense(CurvedTrackingState& state, const ConvexBody& a,
                            const ConvexBody& b) noexcept {
  if (!(std::abs(state.normal.squaredNorm() - 1.0) < 0.5)) state.normal = Vec3::Zero();
  ActiveParts& active = state.active;
  if (active.count > active.pairs.size()) active.count = 0;
  int faces = 0;
  bool usable = true;
  for (std::size_t i = 0; i < active.count; ++i) {
    const auto& [part_a, part_b] = active.pairs[i];
    usable = usable && has_part_or_face(a, part_a) && has_part_or_face(b, part_b);
    faces += (part_a >= first_planar_face(a) ? 1 : 0) + (part_b >= first_planar_face(b) ? 1 : 0);
  }
  if (!usable || faces > 1 || (faces == 1 && active.count > 1)) active.count = 0;
}

// A pair of parts is stored as one number. This is possible because at most one body is a
// polyhedron, and the other has at most two parts and two planar faces. The two features hold three
// such numbers of 21 bits. With one pair only, a tracked query on an edge or a generator would take
// one more step.
inline constexpr unsigned kPartBits = 21;
inline constexpr std::uint64_t kPartNumbers = std::uint64_t{1} << kPartBits;

// 4 p + q + 1, or 0 for none. q is the part of a curved body: A's if B is a polyhedron, otherwise
// B's.
[[nodiscard]] inline std::uint64_t packed(const PartPair& pair, bool b_is_curved) noexcept {
  const std::int32_t p = b_is_curved ? pair.a : pair.b, q = b_is_curved ? pair.b : pair.a;
  const std::uint64_t number =
      4 * static_cast<std::uint64_t>(p) + static_cast<std::uint64_t>(q) + 1;
  return number < kPartNumbers ? number : 0;
}
[[nodiscard]] inline PartPair unpacked(std::uint64_t number, bool b_is_curved) noexcept {
  const auto p = static_cast<std::int32_t>((number - 1) >> 2);
  const auto q = static_cast<std::int32_t>((number - 1) & 3);
  return b_is_curved ? PartPair{p, q} : PartPair{q, p};
}

// Reads any state, even that of another pair, as a CurvedTrackingState that fits these two bodies.
[[nodiscard]] inline CurvedTrackingState read(const TrackingState& state, const ConvexBody& a,
                                              const ConvexBody& b) noexcept {
  CurvedTrackingState found;
  if (state.a.kind != FeatureKind::kDirection) return found;
  found.normal = state.a.point;
  const auto bits = [](std::int32_t half) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(half));
  };
  std::uint64_t all = bits(state.b.feature) << 32 | bits(state.a.feature);
  const bool b_is_curved = b.is_curved();
  for (; all % kPartNumbers != 0 && found.active.count < found.active.pairs.size();
       all >>= kPartBits) {
    found.active.pairs[found.active.count++] = unpacked(all % kPartNumbers, b_is_curved);
  }
  forget_nonsense(found, a, b);
  if (state.a.penetrating && !found.normal.isZero()) found.overlap = Overlap::kLastQuery;
  return found;
}

// The parts of two polyhedra, or of one with more than half a million vertices and facets, may be
// lost.
inline void write(const CurvedTrackingState& from, const ConvexBody& a, const ConvexBody& b,
                  TrackingState& state) noexcept {
  std::uint64_t all = 0;
  const bool b_is_curved = b.is_curved();
  if (b_is_curved || a.is_curved()) {
    for (std::size_t i = from.active.count; i-- > 0;) {
      all = all << kPartBits | packed(from.active.pairs[i], b_is_curved);
    }
  }
  const auto half = [](std::uint64_t bits) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
  };
  state.a = {FeatureKind::kDirection, from.overlap == Overlap::kLastQuery, half(all), from.normal};
  state.b = {FeatureKind::kDirection, false, half(all >> 32), from.point_on_b_B};
}

// The fast effort (newton.cpp). False: the bodies overlap or nearly touch, one of them is
// unbounded, rounding leaves the bounds too wide, or many parts are equally near. The state is then
// a hint for thorough_distance(). It must have passed forget_nonsense().
[[nodiscard]] bool newton_distance(const ConvexBody& a, const ConvexBody& b,
                                   const RelativePose& a_from_b, CurvedTrackingState& state,
                                   DistanceResult& result) noexcept;
// The thorough effort (curved_distance.cpp). Requires a good pose.
[[nodiscard]] DistanceResult thorough_distance(const Query& query,
                                               CurvedTrackingState& state) noexcept;

}  // namespace clearance
