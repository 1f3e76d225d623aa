// Which pieces of two bodies are active: those that are equally near along the best direction.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/convex_body.hpp"

namespace clearance {

// Which piece of A and which of B.
struct PiecePair {
  std::int32_t a = kNone, b = kNone;
  [[nodiscard]] bool operator==(const PiecePair&) const noexcept = default;
};

// A hint and never a fact.
struct ActivePieces {
  std::array<PiecePair, 3> pieces;
  std::size_t count = 0;
};

// Behind its pieces a body's flats are numbered: a bounded polyhedron's facets, or a truncated
// cone's caps, the lower one first. Along a flat's normal all of it is the support set.
[[nodiscard]] inline std::int32_t first_flat(const ConvexBody& body) noexcept {
  return body.is_curved() ? 2 : static_cast<std::int32_t>(body.anchors.size());
}
[[nodiscard]] inline std::int32_t end_of_flats(const ConvexBody& body) noexcept {
  if (body.curved.kind == CurvedShape::Kind::kTruncatedCone) return 4;
  if (body.is_curved() || !body.bounded()) return first_flat(body);
  return first_flat(body) + static_cast<std::int32_t>(body.facets.size());
}

}  // namespace clearance
