// A neighbourhood of the best direction in which no direction has less depth. Its certificate takes
// the derivatives of the support function at one direction. A cover by triangles would need more of
// them the nearer they are to the best direction, without an end.
#pragma once

#include <array>
#include <cstddef>

#include "core/curved/curved_pair.hpp"

namespace clearance {

// Points of A - B around the support set along n. They are support points for directions that are
// tilted by kTilt, so on a planar contact they are corners of the contact.
inline constexpr std::size_t kRing = 4;
inline constexpr double kTilt = 0x1p-27;  // its square is below rounding

struct DepthCap {
  double angle = 0.0;         // rad: h >= depth - tolerance within this angle of n
  double lower = -kInfinity;  // m: h is at least this along all directions
  std::array<Vec3, kRing> ring{};
  int supports = 0;
};

// n: unit, frame A. ball: the radius of a ball that rolls inside A - B, m. depth: h of A - B along
// n, m. active: the pairs of parts whose mean support point is depth n, as search_direction()
// leaves them; nonsense makes the cap smaller.
[[nodiscard]] DepthCap depth_cap(const CurvedPair& pair, const Vec3& n, double depth,
                                 double tolerance, double ball, const ActiveParts& active) noexcept;

}  // namespace clearance
