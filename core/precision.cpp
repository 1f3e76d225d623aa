#include "core/precision.hpp"

#include <algorithm>

#include "core/rounding.hpp"

namespace clearance {

Precision precision(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                    const RelativePose& a_from_b, double farthest) noexcept {
  Precision p;
  const double apart = a_from_b.translation.norm();
  p.reach_a = a.bounding_radius;
  p.reach_b = b.bounding_radius;
  if (!a.bounded()) p.reach_a = std::max(p.reach_a, b.bounding_radius + apart + farthest);
  if (!b.bounded()) p.reach_b = std::max(p.reach_b, a.bounding_radius + apart + farthest);
  p.size = p.reach_a + p.reach_b + apart;
  p.slack = kUlp * (kUlpsOnA * p.reach_a + kUlpsOnB * p.reach_b + kUlpsBetween * apart) +
            a.position_error + b.position_error + a_from_b.rotation_error * p.reach_b +
            a_from_b.translation_error + kUnderflow;
  p.tight = kTightUlps[!a.bounded() + !b.bounded()] * kUlp * p.size;
  return p;
}

}  // namespace clearance
