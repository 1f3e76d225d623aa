#include "monitor/loop/rehearsal.hpp"

namespace clearance {

std::unique_ptr<Rehearsal> Rehearsal::of(const Scene& scene, const Monitor* similar) {
  if (scene.pairs.size() > kMostPairs) return nullptr;
  return std::unique_ptr<Rehearsal>(new Rehearsal(scene, similar));
}

void Rehearsal::run(std::span<const PoseSample> samples, std::span<const JointSample> joints,
                    const TickTime& time) noexcept {
  (void)monitor_.tick(samples, joints, time);
}

}  // namespace clearance
