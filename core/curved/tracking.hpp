// What a pair with a curved body remembers between queries, and how a TrackingState holds it.
#pragma once

#include "core/curved/direction_search.hpp"
#include "core/distance_result.hpp"

namespace clearance {

// A hint and never a fact.
struct CurvedTrackingState {
  Vec3 normal = Vec3::Zero();  // frame A, unit; 0: none
  ActivePieces active;         // such as the bodies have
  // Of the last query: the point of B without its radius, in frame B; and where the bodies overlap,
  // a point of both, frame A.
  Vec3 own_point_on_b = Vec3::Zero(), shared = Vec3::Zero();
};

// Whatever the state says, of these two bodies.
[[nodiscard]] CurvedTrackingState read(const TrackingState& state, const ConvexPolyhedron& a,
                                       const ConvexPolyhedron& b) noexcept;
// What is not of these bodies becomes nothing.
void forget_nonsense(CurvedTrackingState& state, const ConvexPolyhedron& a,
                     const ConvexPolyhedron& b) noexcept;
// Without `shared`. A pair of pieces is one number, since no more than one body is a polyhedron,
// and the other one has two pieces at most; three such numbers are in the two features, 21 bits
// each. Of two polyhedra, or of one with more than a million vertices, none may be kept.
void write(const CurvedTrackingState& from, const ConvexPolyhedron& a, const ConvexPolyhedron& b,
           TrackingState& state) noexcept;

}  // namespace clearance
