#include "core/precision.hpp"

#include <algorithm>

namespace clearance {
namespace {

constexpr double kUlp = 0x1p-53;

// Evaluating n.(R b + t - a) / |n| or |R b + t - a|, with a and b on the features that hold them:
// placing a point on its feature (3), rotating it (6), an edge that is not quite at right angles to
// n (6); the sums, the product and the quotient (8).
constexpr double kOnA = 12, kOnB = 18, kBetween = 10;

// Squares of lengths below 1e-154 underflow, and a norm may be wrong by as much (m).
constexpr double kUnderflow = 1e-150;

// What rounding leaves between the bounds, by how many of the bodies are unbounded: errors of
// direction grow along their rays. Measured on the hard cases of tests/: at most 5, 40 and 250.
constexpr double kTight[] = {8, 64, 320};

}  // namespace

Precision precision(const ConvexPolyhedron& a, const ConvexPolyhedron& b,
                    const RelativePose& a_from_b, double farthest) noexcept {
  Precision p;
  const double apart = a_from_b.translation.norm();
  p.reach_a = a.bounding_radius;
  p.reach_b = b.bounding_radius;
  if (!a.bounded()) p.reach_a = std::max(p.reach_a, b.bounding_radius + apart + farthest);
  if (!b.bounded()) p.reach_b = std::max(p.reach_b, a.bounding_radius + apart + farthest);
  p.size = p.reach_a + p.reach_b + apart;
  p.slack = kUlp * (kOnA * p.reach_a + kOnB * p.reach_b + kBetween * apart) + a.position_error +
            b.position_error + a_from_b.rotation_error * p.reach_b + a_from_b.translation_error +
            kUnderflow;
  p.tight = kTight[!a.bounded() + !b.bounded()] * kUlp * p.size;
  return p;
}

}  // namespace clearance
