// Motions that the adversaries of the tick share, and where a moving body is in between.
#pragma once

#include <cmath>

#include "core/pose.hpp"
#include "tests/monitor/small_cells.hpp"

namespace clearance::test {

inline void turn(Random& random, double angle, Pose& pose) {
  const Vec3 axis = random.in_box(1.0).normalized();
  pose.orientation = Eigen::AngleAxisd(random.uniform(-angle, angle), axis) * pose.orientation;
  pose.orientation.normalize();
}

// At a millisecond a tick every point of a body of a metre keeps well below 3 m/s.
inline void crawl(Random& random, Pose& pose) {
  pose.position += random.in_box(0.0005);
  turn(random, 0.0005, pose);
}

// All crowd around one point, which wanders.
inline void crowd(Random& random, int tick, Pose& pose) {
  const Vec3 centre(std::sin(0.01 * tick), std::cos(0.013 * tick), 0.0);
  pose.position += 0.02 * (centre - pose.position) + random.in_box(0.02);
}

// On the straight way with an even turn, s in [0, 1].
[[nodiscard]] inline Pose between(const Pose& from, const Pose& to, double s) {
  Pose pose;
  pose.position = from.position + s * (to.position - from.position);
  pose.orientation = from.orientation.normalized().slerp(s, to.orientation.normalized());
  return pose;
}

}  // namespace clearance::test
