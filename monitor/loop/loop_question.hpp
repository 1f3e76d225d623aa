// Another thread asks what the loop knows; the tick thread answers between two ticks.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "monitor/loop/loop_statistics.hpp"
#include "monitor/tick/present_body.hpp"

namespace clearance {

// The state of the loop at its last tick.
struct LoopState {
  const Scene& scene;
  const Monitor& monitor;
  const LoopStatistics& statistics;
};

class LoopQuestion {
 public:
  virtual ~LoopQuestion() = default;

  // The tick thread.
  void answer(const LoopState& loop) noexcept {
    copy(loop);
    answered_.store(true, std::memory_order_release);
  }
  [[nodiscard]] bool is_answered() const noexcept {
    return answered_.load(std::memory_order_acquire);
  }

 private:
  // Copies what is asked for into memory that is there already.
  virtual void copy(const LoopState& loop) noexcept = 0;

  std::atomic<bool> answered_{false};
};

// Asks where bodies of the scene are, and its first joint variables. The scene must be that of the
// loop.
class PoseQuestion final : public LoopQuestion {
 public:
  explicit PoseQuestion(std::vector<SceneBody> bodies, std::size_t variables = 0)
      : bodies_(std::move(bodies)), poses_(bodies_.size()), joints_(variables) {}

  // Once it is answered: in the order of the bodies. All poses are those of the last tick.
  [[nodiscard]] std::span<const PresentPose> poses() const noexcept { return poses_; }
  [[nodiscard]] std::span<const PresentJoint> joints() const noexcept { return joints_; }

 private:
  void copy(const LoopState& loop) noexcept override {
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      poses_[i] = present_pose(bodies_[i], loop.monitor);
    for (std::uint32_t i = 0; i < joints_.size(); ++i) joints_[i] = loop.monitor.present_joint(i);
  }

  std::vector<SceneBody> bodies_;
  std::vector<PresentPose> poses_;
  std::vector<PresentJoint> joints_;
};

}  // namespace clearance
