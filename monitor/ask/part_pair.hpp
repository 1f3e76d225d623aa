// One pair of convex parts, and bounds of its distance over a stretch of a motion.
#pragma once

#include <cstdint>

#include "core/distance_result.hpp"
#include "monitor/ask/chains.hpp"
#include "monitor/ask/posture.hpp"

namespace clearance {

struct PartPair {
  std::uint32_t base = 0, tip = 0;  // parts; the base is the one in whose frame the tip moves
  std::uint32_t object_base = 0, object_tip = 0;
  bool swapped = false;  // the base is the second object of the pair in the scene
  Chain chain;
  // m/s: the speed at which the base may come nearer, beside all that the question states.
  double unstated_speed = 0.0;
  double age = 0.0;       // s: it may have done so for this long before the first instant
  double rounding = 0.0;  // m: the error of the distance from the rounding of positions of joints
  TrackingState tracking;
};

// The facts about a stretch once its middle was examined.
struct StretchBounds {
  double lower = 0.0;        // at all instants of the stretch, m
  bool queried = false;      // false: `lower` is that of two spheres
  double upper = kInfinity;  // at the middle, m; 0: the bodies overlap there
  double closing = 0.0;      // m/s: at the middle, positive if the distance falls
  Vec3 on_base = Vec3::Zero(), on_tip = Vec3::Zero();  // closest points at the middle, world
};

// Bounds the distance of a pair over `stretch`. `posture` is that at the instant `middle` of it.
// It makes no query if the spheres around the parts prove that the distance is at least `enough`.
// `begin` is the first instant of the motion, s.
[[nodiscard]] StretchBounds bounds_over(const Stretch& stretch, double middle, double enough,
                                        double begin, Posture& posture, PartPair& pair) noexcept;

}  // namespace clearance
