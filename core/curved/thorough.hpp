// The thorough effort, for the queries that Newton's method leaves open. Each function improves
// pair.bounds.
#pragma once

#include "core/curved/curved_pair.hpp"

namespace clearance {

// direction_search.cpp: searches from the direction n (unit, frame A) until the bounds have
// converged or nothing improves them. Returns the number of support points that it took.
int search_direction(CurvedPair& pair, const Vec3& n, ActiveParts& active) noexcept;

// curved_distance.cpp: a first direction by the algorithm of Gilbert, Johnson and Keerthi.
struct CurvedStart {
  Vec3 normal;           // unit, frame A
  bool overlap = false;  // the bodies share a point, up to rounding: bounds.points
  ActiveParts active;    // those of the simplex that is nearest to the origin
};
// Ends when the lower bound is half of the upper one, or when the simplex holds the origin.
[[nodiscard]] CurvedStart start_direction(CurvedPair& pair) noexcept;

// cap.cpp: along a truncated cone's axis, a whole cap is the support set, and the support function
// has no derivative.
struct CapTest {
  bool closest = false;   // the other body's support set lies over the cap, and the bounds have it
  SupportPair support{};  // otherwise: the support along the axis, from which a search begins
  Vec3 normal = Vec3::Zero();
  std::array<PartPair, 3> parts{};  // the other body's nearest point lies on these
  std::size_t count = 0;
};
// Tests the cap of A (or of B) that faces along n, and sets the rim's azimuth towards the other
// body.
[[nodiscard]] CapTest test_cap(CurvedPair& pair, bool cap_is_of_a, const Vec3& n) noexcept;

// depth.cpp: the least overlap of the bodies over all directions. The overlap along a direction has
// several minima, so a search from one direction bounds the least one from above only.
struct DepthBounds {
  double lower = -kInfinity;  // m; the greatest that is known
  int supports = 0;
};
// Improves pair.bounds.lower, minus the depth, to the best that it finds. `active`: the active
// parts with which a search has ended in pair.bounds; without any, one more search finds them. Ends
// without a bound if the bodies turn out to be disjoint.
[[nodiscard]] DepthBounds bound_depth(CurvedPair& pair, const ActiveParts& active) noexcept;

// symmetric_depth.cpp: a lower bound of the depth, in m as computed, if symmetry gives one; else
// -infinity. The minima of symmetric pairs fill a circle or a sphere, for which bound_depth() would
// need too many triangles of directions. The bound is the greatest of
// - inscribed balls: their radii less the distance of their centres;
// - ellipsoids around nearly one centre along nearly the same axes: the least sum of two semi-axes;
// - solids of revolution around nearly one axis: the least over directions in one half-plane.
// A nearly symmetric pair is moved until it is symmetric, and the bound is reduced by the move.
// Solids of revolution whose move is longer than `move` (m) are left out.
[[nodiscard]] Ball inscribed_ball(const BodyView& view) noexcept;
[[nodiscard]] double least_symmetric_depth(const CurvedPair& pair, double move) noexcept;

}  // namespace clearance
