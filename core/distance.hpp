// How far apart are two convex bodies? Tracked: each call starts where the last one ended.
//
// Minimises |b - a| over a in A, b in B with the active-set QP of core/dqp3.hpp (§3.3, §3.4). Every
// answer carries its own proof: a separating direction bounds it from below (weak duality, §3.2),
// witness points on the bodies from above. Everything is in frame A, in metres.
#pragma once

#include <cstdint>

#include "core/convex_polyhedron.hpp"
#include "core/pose.hpp"

namespace clearance {

enum class DistanceStatus : std::uint8_t {
  kConverged,       // upper - lower is rounding only
  kFarAway,         // lower >= far_away; nobody asked by how much
  kTouching,        // apart or overlapping by less than rounding can tell
  kOverlapping,     // A and B share a point
  kIterationLimit,  // the bounds hold, but are wider than rounding
};

[[nodiscard]] const char* name(DistanceStatus status) noexcept;

// Always, rounding included: lower <= true distance <= upper, for the exact bodies of the shapes'
// doubles. Signed where radii overlap but cores do not (sphere against box: minus the depth). Where
// cores overlap the distance reported is minus the sum of the radii: no deeper depth is claimed.
struct DistanceResult {
  double distance = 0.0;  // best estimate, within the bounds
  double lower = 0.0, upper = 0.0;
  Vec3 normal = Vec3::Zero();  // unit, from A towards B; NaN when unknown
  Vec3 point_on_a = Vec3::Zero(), point_on_b = Vec3::Zero();  // witness points, both in frame A
  DistanceStatus status = DistanceStatus::kIterationLimit;
  std::uint16_t iterations = 0;
};

// What a pair remembers between calls: the active feature of each body and where the witness lay on
// it. A hint and never a fact: an empty, stale or wrong state costs iterations and leaves the
// bounds true.
struct TrackingState {
  static constexpr std::uint8_t kCold = 255;
  struct Side {
    std::uint8_t dimension =
        kCold;  // 0 vertex, 1 edge, 2 facet, 3 inside (none active); kCold: no hint
    std::int32_t feature = kNone;
    Vec3 point = Vec3::Zero();  // in the body's own frame
  };
  Side a, b;
};

struct DistanceOptions {
  double far_away = kInfinity;  // m: stop as soon as the lower bound reaches this
};

// noexcept, no heap, deterministic. Any state is accepted.
[[nodiscard]] DistanceResult distance(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                                      const RelativePose& a_from_b, TrackingState& state,
                                      const DistanceOptions& options = {}) noexcept;

}  // namespace clearance
