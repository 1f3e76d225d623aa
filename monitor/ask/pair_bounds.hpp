// Bounds of the distance of two convex parts over a stretch of a motion.
#pragma once

#include "core/distance_result.hpp"
#include "monitor/ask/part_pairs.hpp"
#include "monitor/ask/posture.hpp"

namespace clearance {

// The motion of a bundle's tip relative to its base over a stretch.
struct TipMotion {
  double half = 0.0;   // s: the longer of the stretch's parts before and after its middle
  double moved = 0.0;  // m: no point of the tip's sphere leaves its place at the middle by more
  // m: the error of the distance from the rounding of positions of joints, and from the stated
  // errors of the model.
  double error = 0.0;
  bool has_twist = false;  // the rest is known: the stretch is in one segment
  // At the middle a point x of the tip moves at linear + angular x (x - centre of the sphere).
  Twist twist;
  double acceleration = 0.0;  // of every point, at most, m/s2
  Nearing nearing;            // by variables of the tip that nothing states
};

[[nodiscard]] TipMotion tip_motion(const Bundle& bundle, const Stretch& stretch, double middle,
                                   Posture& posture) noexcept;

// No point of the tip's sphere is faster in the stretch, m/s. Requires the twist.
[[nodiscard]] double largest_tip_speed(const TipMotion& motion, double radius) noexcept;

// The distance at an instant is at least this, m: by spheres and boxes around the parts. It ends as
// soon as it is `enough`.
[[nodiscard]] double gap_at_least(const PosedPart& base, const PartBox& base_box,
                                  const PosedPart& tip, const PartBox& tip_box,
                                  double enough) noexcept;

// The answer to a distance query at the middle of a stretch.
struct PairAtMiddle {
  double lower = 0.0;                                  // m
  double upper = 0.0;                                  // m; negative: the bodies overlap
  bool separated = false;                              // by a slab across `normal`
  Vec3 normal = Vec3::Zero();                          // in the world, from the base to the tip
  Vec3 on_base = Vec3::Zero(), on_tip = Vec3::Zero();  // closest points in the world
};

[[nodiscard]] PairAtMiddle query_pair(const PosedPart& base, const PosedPart& tip,
                                      TrackingState& tracking) noexcept;
// The same for a base that is what a sensor sees. Its nearest element gives points and normal.
[[nodiscard]] PairAtMiddle query_seen(const CloudPairs::Content& content, const PosedPart& base,
                                      const PosedPart& tip, SlabBody& slab,
                                      CloudTracking& tracking) noexcept;

// The distance is at least this over the whole stretch, m. The bound is made as good as possible
// unless a worse one is `enough`.
[[nodiscard]] double lower_over(const PairAtMiddle& found, const PosedPart& base,
                                const PosedPart& tip, bool tip_keeps_direction,
                                const TipMotion& motion, const ObjectApproach& approach,
                                double enough) noexcept;

// The distance is at most this over the whole stretch, m.
[[nodiscard]] double upper_over(const PairAtMiddle& found, const PosedPart& tip,
                                const TipMotion& motion, const ObjectApproach& approach) noexcept;

// m/s: at the middle, positive if the distance falls.
[[nodiscard]] double closing_speed(const PairAtMiddle& found, const PosedPart& tip,
                                   const TipMotion& motion,
                                   const ObjectApproach& approach) noexcept;

}  // namespace clearance
