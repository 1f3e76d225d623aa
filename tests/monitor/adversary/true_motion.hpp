// The true motion of the cell of inputs that lie: smooth, within every stated speed and limit, and
// never at rest. Its kinematics are products of 4x4 matrices in long double, which share nothing
// with the monitor.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/pose.hpp"
#include "tests/monitor/adversary/lying_cell.hpp"

namespace clearance::test::lies {

using TruePose = Eigen::Matrix<long double, 4, 4>;
using TruePoint = Eigen::Matrix<long double, 3, 1>;

struct TrueJoint {
  long double position = 0.0L, velocity = 0.0L;  // rad or m, per second
};

class TrueMotion {
 public:
  // `far`: the continuous joints have turned 40,000 times before.
  TrueMotion(std::uint64_t seed, bool far);

  // Times are ns since the start.
  // World from ball 0 to 2, or parent from child of a frame.
  [[nodiscard]] TruePose pose(Channel channel, std::int64_t t) const;
  // The twist of a ball's frame, in world coordinates.
  [[nodiscard]] Twist twist(Channel channel, std::int64_t t) const;
  // `robot` is kArm or kPost.
  [[nodiscard]] std::array<TrueJoint, kJoints> joints(Channel robot, std::int64_t t) const;

  // The arm has the part in its hand for this time, and puts it down where it then is.
  void carry(std::int64_t from, std::int64_t to);
  [[nodiscard]] bool carries(std::int64_t t) const { return t >= carried_from_ && t < carried_to_; }

  // The points that the camera sees: at rest, in the world, m.
  [[nodiscard]] static const std::array<TruePoint, kSeenPoints>& seen_points();
  // The depth of the plate before the lens, m.
  [[nodiscard]] static long double plate_depth(std::int64_t t);
  // The place of the person in the map, who is a point, in the world, m.
  [[nodiscard]] static TruePoint walker(std::int64_t t);
  // The centres of all bodies in the world, m; of what the camera sees, the first point.
  using Centres = std::array<TruePoint, kBodies>;
  [[nodiscard]] Centres centres(std::int64_t t) const;
  [[nodiscard]] static long double distance(std::size_t a, std::size_t b, const Centres& centres);
  [[nodiscard]] static double radius(std::size_t body);
  // No centre of the body is faster, m/s; what is seen: beside the stated speed of its sensor.
  [[nodiscard]] static double fastest(std::size_t body);

  // No point of a ball is farther from the middle of its orbit: the largest radius of an orbit, and
  // the place of the sphere in the ball's frame with its radius, m.
  static constexpr double kBallReach = 1.1 + 0.15 + 0.1;
  // No coordinate of the base in the world is larger than this, m.
  static constexpr double kBaseReach = 0.05 + 0.3 + 0.03 * 0.3;

 private:
  struct Orbit {
    TruePoint centre;
    long double radius = 0, rate = 0, phase = 0, tilt = 0;  // m, rad/s, rad, rad
  };
  [[nodiscard]] TruePoint on(const Orbit& orbit, std::int64_t t) const;

  std::array<Orbit, 4> orbits_;  // three balls and the follower
  std::array<std::array<long double, kJoints>, 2> phases_{};
  long double base_phase_ = 0, turned_ = 0;
  std::int64_t carried_from_ = 0, carried_to_ = 0;
  TruePoint put_down_ = TruePoint::Zero();
};

[[nodiscard]] Pose as_pose(const TruePose& pose);

}  // namespace clearance::test::lies
