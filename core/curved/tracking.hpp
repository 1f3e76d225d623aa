// What a pair with a curved body remembers between queries, and how a TrackingState holds it.
#pragma once

#include <cmath>

#include "core/curved/active_pieces.hpp"
#include "core/curved/piece.hpp"
#include "core/distance_result.hpp"

namespace clearance {

// A hint and never a fact.
struct CurvedTrackingState {
  Vec3 normal = Vec3::Zero();  // frame A, of about unit length; 0: none
  ActivePieces active;         // such as the bodies have; or one flat and the other body's piece
  // Of the last query: the point of B without its radius, in frame B; and where the bodies overlap,
  // a point of both, frame A.
  Vec3 own_point_on_b = Vec3::Zero(), shared = Vec3::Zero();
};

// Has the body this piece or flat?
[[nodiscard]] inline bool has_piece(const ConvexBody& body, std::int32_t number) noexcept {
  if (number < 0) return false;
  return number < pieces_of(body) || (number >= first_flat(body) && number < end_of_flats(body));
}

// What is not of these bodies becomes nothing: more than one flat, and flats of several pairs.
inline void forget_nonsense(CurvedTrackingState& state, const ConvexBody& a,
                            const ConvexBody& b) noexcept {
  if (!(std::abs(state.normal.squaredNorm() - 1.0) < 0.5)) state.normal = Vec3::Zero();
  ActivePieces& active = state.active;
  if (active.count > active.pieces.size()) active.count = 0;
  int flats = 0;
  bool usable = true;
  for (std::size_t i = 0; i < active.count; ++i) {
    const auto& [of_a, of_b] = active.pieces[i];
    usable = usable && has_piece(a, of_a) && has_piece(b, of_b);
    flats += (of_a >= first_flat(a) ? 1 : 0) + (of_b >= first_flat(b) ? 1 : 0);
  }
  if (!usable || flats > 1 || (flats == 1 && active.count > 1)) active.count = 0;
}

// A pair of pieces is one number, since no more than one body is a polyhedron, and the other one
// has two pieces and two flats at most; three such numbers are in the two features, 21 bits each.
inline constexpr unsigned kPieceBits = 21;
inline constexpr std::uint64_t kPieceNumbers = std::uint64_t{1} << kPieceBits;

// 4 p + q and 1, q being the piece of a curved body: of A if B is a polyhedron, else of B. 0: none.
[[nodiscard]] inline std::uint64_t packed(const PiecePair& pair, bool b_is_curved) noexcept {
  const std::int32_t p = b_is_curved ? pair.a : pair.b, q = b_is_curved ? pair.b : pair.a;
  const std::uint64_t number =
      4 * static_cast<std::uint64_t>(p) + static_cast<std::uint64_t>(q) + 1;
  return number < kPieceNumbers ? number : 0;
}
[[nodiscard]] inline PiecePair unpacked(std::uint64_t number, bool b_is_curved) noexcept {
  const auto p = static_cast<std::int32_t>((number - 1) >> 2);
  const auto q = static_cast<std::int32_t>((number - 1) & 3);
  return b_is_curved ? PiecePair{p, q} : PiecePair{q, p};
}

// Whatever the state says, of these two bodies.
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
  for (; all % kPieceNumbers != 0 && found.active.count < found.active.pieces.size();
       all >>= kPieceBits) {
    found.active.pieces[found.active.count++] = unpacked(all % kPieceNumbers, b_is_curved);
  }
  forget_nonsense(found, a, b);
  return found;
}

// Without `shared`. Of two polyhedra, or of one with more than half a million vertices and facets,
// no pieces may be kept.
inline void write(const CurvedTrackingState& from, const ConvexBody& a, const ConvexBody& b,
                  TrackingState& state) noexcept {
  std::uint64_t all = 0;
  const bool b_is_curved = b.is_curved();
  if (b_is_curved || a.is_curved()) {
    for (std::size_t i = from.active.count; i-- > 0;) {
      all = all << kPieceBits | packed(from.active.pieces[i], b_is_curved);
    }
  }
  const auto half = [](std::uint64_t bits) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits));
  };
  state.a = {FeatureKind::kDirection, false, half(all), from.normal};
  state.b = {FeatureKind::kDirection, false, half(all >> 32), from.own_point_on_b};
}

}  // namespace clearance
