// The result of a distance query, and the state that a pair keeps between queries.
#pragma once

#include <cstdint>

#include "core/convex_body.hpp"

namespace clearance {

enum class DistanceStatus : std::uint8_t {
  kConverged,       // upper - lower is rounding only
  kTouching,        // disjoint or overlapping by less than rounding: the bounds contain 0
  kOverlapping,     // certified: upper < 0
  kIterationLimit,  // the bounds hold, but are wider than rounding
  kDepthNotAsked,   // not certified disjoint, and DistanceOptions::depth is false
  kBadPose,         // the pose is bad, see below: nothing is known
};

[[nodiscard]] const char* name(DistanceStatus status) noexcept;

// The method that has answered: core/README.md, "What the iteration is".
enum class DistancePath : std::uint8_t {
  kFeatureTracking,  // feature tracking certified it
  kActiveSet,        // the active-set iteration, and for bodies that touch or overlap the depth
  kGjk,              // the active-set iteration and then GJK
  kPenetration,      // depth or contact, at once from features
  kDirection,        // of curved bodies: the search for the separating direction (core/curved)
};

// Always, rounding included: lower <= true distance <= upper. The truth is that of the exact bodies
// whose numbers are the shapes' doubles. The distance is signed. If the bodies are disjoint, it is
// that of the closest points. If they overlap, it is minus the penetration depth: the length of the
// shortest translation after which the bodies only touch (core/penetration/depth.hpp). A motion
// that moves every point by at most s changes it by at most s.
//
// Disjoint bodies: point_on_a and point_on_b are closest points, and point_on_b - point_on_a =
// distance * normal to within sqrt(upper^2 - lower^2). The points prove the upper bound and the
// normal proves the lower one. So the bounds say by how much the points and the normal can
// disagree.
//
// Overlapping bodies: B moved by depth * normal only touches A, and the two points are those that
// meet there. They are support points: point_on_a of A along the normal, and point_on_b of B
// against it, at B's present place. Again point_on_b - point_on_a = distance * normal. For curved
// bodies this holds along the normal, to upper - lower. Across it, it holds unless each point is in
// a face, and points that meet were not found.
//
// Touching bodies: the two points coincide up to rounding. Unbounded bodies may touch far away; the
// rounding is then that of the coordinates at that place.
//
// Two unbounded bodies are answered in doubles, with true bounds. If doubles cannot tell along
// which directions neither body is unbounded, lower is -infinity and the status kIterationLimit.
//
// One rule holds here and in reports: an unknown bound is infinite, any other unknown figure is
// NaN. A bad pose leaves everything unknown. A pose is bad if it is not finite or if its quaternion
// is off unit length by more than kUnitTolerance. It is also bad if the frames are more than
// kLargestCoordinate from each other. Nothing else makes a NaN.
struct DistanceResult {
  double distance = 0.0;  // best estimate, within the bounds
  double lower = 0.0, upper = 0.0;
  Vec3 normal = Vec3::Zero();                                 // unit, from A towards B
  Vec3 point_on_a = Vec3::Zero(), point_on_b = Vec3::Zero();  // witness points, both in frame A
  DistanceStatus status = DistanceStatus::kIterationLimit;
  DistancePath path = DistancePath::kFeatureTracking;
  std::uint16_t iterations = 0;
};
static_assert(sizeof(DistanceResult) == 104 && alignof(DistanceResult) == 8);

// The active part of a body's boundary. kInside: nothing is active. kUnknown: no hint. kDirection:
// the pair has a curved body.
enum class FeatureKind : std::uint8_t {
  kVertex,
  kEdge,
  kFacet,
  kInside,
  kDirection,
  kUnknown = 255
};

// The state that a pair keeps between calls: the active feature of each body and the witness point
// on it. For overlapping bodies, these are the features that would touch if B were moved by the
// depth. A hint and never a fact: an empty, stale or wrong state costs iterations and leaves the
// bounds true.
//
// For a pair with a curved body, `kind` is kDirection, a.point is the last separating direction
// (frame A), and `feature` names smooth parts (core/curved/tracking.hpp).
//
// After a query the two points are the witness points before radii, each in its body's frame. With
// a curved body this holds for b.point only. The point transform(world_from_b, state.b.point) lies
// on B to the rounding of B's own pose, however far away A is.
struct alignas(64) TrackingState {
  struct Side {
    FeatureKind kind = FeatureKind::kUnknown;
    bool penetrating = false;      // of A only: the bodies touched or overlapped
    std::int32_t feature = kNone;  // index into the body's vertices, edges or facets
    Vec3 point = Vec3::Zero();     // in the body's frame
  };
  Side a, b;
};
static_assert(sizeof(TrackingState) == 64, "a cache line a pair");

}  // namespace clearance
