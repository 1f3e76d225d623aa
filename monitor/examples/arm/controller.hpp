// A controller with a barrier. Its joint velocities move the end point along its path. Each
// distance may shrink no faster than in proportion to its excess over a minimum.
//
//   minimise   |J dq - v|^2 + damping |dq - home|^2
//   subject to gradient . dq + drift >= -rate (lower - keep)    for each pair that is near
//              limits of joint velocities and positions
//
// The null space of the task yields first, and the task only if that is not enough.
#pragma once

#include <cstdint>
#include <vector>

#include "config/scene/scene.hpp"
#include "monitor/client/client.hpp"
#include "monitor/examples/arm/arm_model.hpp"

namespace clearance::avoid {

struct ControllerOptions {
  bool avoids = true;    // false: the task alone
  double keep_m = 0.08;  // the lower bound that pairs keep; 0.01 between links of the arm
  double rate_hz = 4.0;  // how fast the excess over keep_m may shrink
};

// The wanted position and velocity of the end point.
struct Target {
  Vec3 position, velocity;  // m, m/s
};

class Controller {
 public:
  // `home` has the preferred positions of the arm, in the order of Scene::variables. Scene and
  // model must outlive this.
  Controller(const Scene& scene, const ArmModel& arm, std::vector<double> home,
             const ControllerOptions& options);

  // Returns velocities in the order of Scene::variables, rad/s or m/s, for the positions at which
  // the arm was placed. `gradients` must belong to the same positions, and all must be known.
  [[nodiscard]] std::vector<double> velocities(const std::vector<double>& positions,
                                               const Target& target,
                                               const clearance_msg_Gradients& gradients) const;

 private:
  const Scene& scene_;
  const ArmModel& arm_;
  std::vector<double> home_;
  ControllerOptions options_;
};

}  // namespace clearance::avoid
