// Runs the inputs of the last tick again in a second monitor, shortly before the next tick.
//
// A loop that has slept for most of a millisecond finds its caches, translation buffers and branch
// predictors cold: its ticks take 2 to 5 times as long as ticks in a row. A rehearsal runs the code
// of a tick, on the same bodies, and its report is thrown away. It shares nothing with the loop's
// monitor that a tick writes, so no report depends on it.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "monitor/monitor.hpp"

namespace clearance {

class Rehearsal {
 public:
  // In larger scenes most of the time goes into the memory of pairs, which a second monitor does
  // not fetch.
  static constexpr std::size_t kMostPairs = 2'000;
  // Null: the scene has more pairs. `similar` may save time, as in the constructor of Monitor. The
  // scene must outlive the calls of run().
  [[nodiscard]] static std::unique_ptr<Rehearsal> of(const Scene& scene,
                                                     const Monitor* similar = nullptr);

  // Ids are those of this scene.
  [[nodiscard]] bool is_of(const Scene& scene) const noexcept { return &scene == &scene_; }
  // No heap, no locks. `time`: that of the last tick.
  void run(std::span<const PoseSample> samples, std::span<const JointSample> joints,
           const TickTime& time) noexcept;

 private:
  Rehearsal(const Scene& scene, const Monitor* similar) : scene_(scene), monitor_(scene, similar) {}

  const Scene& scene_;
  Monitor monitor_;
};

}  // namespace clearance
