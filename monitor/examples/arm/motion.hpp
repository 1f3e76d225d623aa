// The motion of the example's arm: from one point of its hand to the next, with the hand upright.
#pragma once

#include <array>

namespace clearance::pick {

// A point between the fingertips, in cylindrical coordinates about the arm's base. The azimuth is 0
// on the negative x axis and grows clockwise as seen from above, as the first joint's position
// does.
struct HandPoint {
  double azimuth = 0.0;  // rad
  double radius = 0.6;   // m
  double height = 0.6;   // m, in the world
  double finger = 0.03;  // m: the position of the finger's joint
};

// Positions of the joints of config/cells/seven_joint_arm, the finger last; rad, m.
inline constexpr int kJoints = 8;
using Positions = std::array<double, kJoints>;

// Positions that place the hand there, pointing downwards. The point has to be within reach: 0.4 to
// 0.78 m from the second joint, less the hand.
[[nodiscard]] Positions positions_at(const HandPoint& point);

// The point on the path between two points, and its rates of change, after this share of the
// motion, 0 to 1. The motion begins and ends at rest.
struct Step {
  Positions positions, rates;  // rates: for each second
};
[[nodiscard]] Step step_between(const HandPoint& from, const HandPoint& to, double share,
                                double seconds);

}  // namespace clearance::pick
