// Joints 2, 4 and 6 turn about parallel axes: two links of equal length and the hand, in the plane
// that joint 1 turns.
#include "monitor/examples/arm/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace clearance::pick {
namespace {

// Lengths of config/cells/seven_joint_arm/arm.urdf, m.
constexpr double kShoulderHeight = 0.34;
constexpr double kLink = 0.40;        // shoulder to elbow, and elbow to wrist
constexpr double kWristToTip = 0.19;  // wrist to the fingertips

HandPoint between(const HandPoint& from, const HandPoint& to, double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  const double grown = s * s * s * (10.0 + s * (6.0 * s - 15.0));
  const auto mixed = [&](double a, double b) { return a + grown * (b - a); };
  return {mixed(from.azimuth, to.azimuth), mixed(from.radius, to.radius),
          mixed(from.height, to.height), mixed(from.finger, to.finger)};
}

}  // namespace

Positions positions_at(const HandPoint& point) {
  const double wrist = point.height + kWristToTip - kShoulderHeight;
  const double squared = point.radius * point.radius + wrist * wrist;
  const double cosine = squared / (2.0 * kLink * kLink) - 1.0;
  const double elbow = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double upper = std::atan2(point.radius, wrist) - 0.5 * elbow;
  return {point.azimuth, -upper,      0.0, elbow, 0.0, upper + elbow - std::numbers::pi,
          0.0,           point.finger};
}

Step step_between(const HandPoint& from, const HandPoint& to, double share, double seconds) {
  constexpr double kSmall = 1e-4;
  Step step{positions_at(between(from, to, share)), {}};
  const Positions before = positions_at(between(from, to, share - kSmall)),
                  after = positions_at(between(from, to, share + kSmall));
  for (int i = 0; i < kJoints; ++i)
    step.rates[i] = (after[i] - before[i]) / (2.0 * kSmall * seconds);
  return step;
}

}  // namespace clearance::pick
