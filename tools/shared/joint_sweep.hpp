// The default motion of a cell's robots, within the limits of their joints.
#pragma once

#include <cstdint>
#include <vector>

#include "config/cell/simulation.hpp"
#include "config/scene/scene.hpp"
#include "monitor/inputs/joint_batch.hpp"

namespace clearance {

// A sample without a stamp or a source.
[[nodiscard]] JointSample moving_joint(std::size_t variable, double position, double velocity);

// Every position swings about the middle of its limits with a frequency of its own. It moves
// through a share of its range, at most at half its velocity limit. A joint without limits
// swings through a quarter turn to either side. One that the cell holds stands.
class JointSweep {
 public:
  static constexpr double kUsualShare = 0.9;

  // The scene must outlive this. `share`: of the ranges, 0 to 1.
  explicit JointSweep(const Scene& scene, double share = kUsualShare);
  // Positions and velocities of all variables, `t_s` after the start, in their order.
  void at(double t_s, std::vector<JointSample>& joints) const;

 private:
  std::vector<Swing> swings_;  // by variable
};

}  // namespace clearance
