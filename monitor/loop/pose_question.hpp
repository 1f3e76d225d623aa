// Another thread asks for present poses of bodies; the tick thread answers between two ticks.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/present_body.hpp"

namespace clearance {

// Allocates in its constructor only.
class PoseQuestion {
 public:
  explicit PoseQuestion(std::vector<SceneBody> bodies)
      : bodies_(std::move(bodies)), poses_(bodies_.size()) {}

  // The tick thread. All poses are those of the last tick.
  void answer(const Monitor& monitor) noexcept {
    for (std::size_t i = 0; i < bodies_.size(); ++i) poses_[i] = present_pose(bodies_[i], monitor);
    answered_.store(true, std::memory_order_release);
  }

  [[nodiscard]] bool is_answered() const noexcept {
    return answered_.load(std::memory_order_acquire);
  }
  // Once it is answered: in the order of the bodies.
  [[nodiscard]] std::span<const PresentPose> poses() const noexcept { return poses_; }

 private:
  std::vector<SceneBody> bodies_;
  std::vector<PresentPose> poses_;
  std::atomic<bool> answered_{false};
};

}  // namespace clearance
