// The samples that a simulated cell's moving objects would report.
#pragma once

#include <vector>

#include "config/cell/simulation.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

[[nodiscard]] inline std::vector<PoseSample> simulated_samples(const Simulation& simulation,
                                                               double t_s, std::int64_t now_ns) {
  std::vector<PoseAt> poses;
  poses_at(simulation, t_s, poses);
  std::vector<PoseSample> samples;
  for (const PoseAt& at : poses) {
    samples.push_back({.object = at.object,
                       .stamp_ns = now_ns,
                       .world_from_object = at.world_from_object,
                       .twist = at.twist,
                       .has_twist = true});
  }
  return samples;
}

}  // namespace clearance
