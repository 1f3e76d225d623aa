// What a distance query returns, and what a pair remembers between queries.
#pragma once

#include <cstdint>

#include "core/convex_body.hpp"

namespace clearance {

enum class DistanceStatus : std::uint8_t {
  kConverged,       // upper - lower is rounding only
  kTouching,        // apart or overlapping by less than rounding can tell: the bounds contain 0
  kOverlapping,     // certified: upper < 0
  kIterationLimit,  // the bounds hold, but are wider than rounding
  kDepthNotAsked,   // not certified apart, and DistanceOptions::depth is false
  kBadPose,         // no pose, see below: nothing is known
};

[[nodiscard]] const char* name(DistanceStatus status) noexcept;

// Which way an answer came: core/README.md, "What the iteration is".
enum class DistancePath : std::uint8_t {
  kWalk,         // feature tracking certified it
  kActiveSet,    // the active-set iteration, and of what touches or overlaps then the depth
  kGjk,          // the active-set iteration and then GJK
  kPenetration,  // penetration depth, at once from the features of the last overlap
  kDirection,    // of curved bodies: the search for the separating direction (core/curved)
};

// Always, rounding included: lower <= true distance <= upper, for the exact bodies of the shapes'
// doubles. The distance is signed: apart, that of the closest points; overlapping, minus the depth,
// the length of the shortest translation after which the bodies only touch
// (core/penetration/depth.hpp). Either way no motion that moves every point by at most s changes it
// by more than s.
//
// Apart, point_on_a and point_on_b are closest points, and point_on_b - point_on_a = distance *
// normal to within sqrt(upper^2 - lower^2): the points prove the upper bound and the normal the
// lower one, so that these two bounds say how far one can be off the other. Overlapping, B moved by
// depth * normal only touches A, and the two points are those that meet there: point_on_a is A's
// farthest along the normal, point_on_b is B's farthest against it (where B is now), and again
// point_on_b - point_on_a = distance * normal; of curved bodies along the normal only, to upper -
// lower, and across it both points are anywhere in the contact. Touching, they coincide up to
// rounding. Unbounded bodies may meet far away: then to the rounding of coordinates there.
//
// Two unbounded bodies are answered in doubles, with true bounds: where these cannot tell along
// which directions neither body is unbounded, lower is -infinity and the status kIterationLimit.
//
// One rule for what is unknown, here and in reports: a bound that is not known is infinite, a
// figure that is not known is NaN. All of it is unknown of a bad pose: one that is not finite, with
// a quaternion that is off unit length by more than kUnitTolerance, or with frames more than
// kLargestCoordinate apart. Nothing else makes a NaN.
struct DistanceResult {
  double distance = 0.0;  // best estimate, within the bounds
  double lower = 0.0, upper = 0.0;
  Vec3 normal = Vec3::Zero();                                 // unit, from A towards B
  Vec3 point_on_a = Vec3::Zero(), point_on_b = Vec3::Zero();  // witness points, both in frame A
  DistanceStatus status = DistanceStatus::kIterationLimit;
  DistancePath path = DistancePath::kWalk;
  std::uint16_t iterations = 0;
};
static_assert(sizeof(DistanceResult) == 104 && alignof(DistanceResult) == 8);

// What of a body's boundary is active; kInside: nothing is. kUnknown: no hint. kDirection: of a
// pair with a curved body.
enum class FeatureKind : std::uint8_t {
  kVertex,
  kEdge,
  kFacet,
  kInside,
  kDirection,
  kUnknown = 255
};

// What a pair remembers between calls: the active feature of each body and where the witness lay on
// it; of overlapping bodies, those that would touch if B were moved by its depth. A hint and never
// a fact: an empty, stale or wrong state costs iterations and leaves the bounds true.
//
// Of a pair with a curved body `kind` is kDirection, a.point the last separating direction (frame
// A), and `feature` names smooth parts (core/curved/tracking.hpp).
//
// After a query the two points, or b.point alone, are the witness points,
// before radii, each in its own body's frame: transform(world_from_b, state.b.point) lies on B to
// the rounding of B's own pose, however far away A is.
struct alignas(64) TrackingState {
  struct Side {
    FeatureKind kind = FeatureKind::kUnknown;
    bool penetrating = false;      // of A only: the bodies overlapped
    std::int32_t feature = kNone;  // index into the body's vertices, edges or facets
    Vec3 point = Vec3::Zero();     // in the body's own frame
  };
  Side a, b;
};
static_assert(sizeof(TrackingState) == 64, "a cache line a pair");

}  // namespace clearance
