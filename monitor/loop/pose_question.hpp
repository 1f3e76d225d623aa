// Another thread asks for present poses of bodies; the tick thread answers between two ticks.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "monitor/monitor.hpp"

namespace clearance {

// A body of the scene that the loop ticks: an object, or a link without shapes.
struct AskedBody {
  bool is_link = false;
  std::uint32_t object = 0;           // index into Scene::objects
  std::uint32_t robot = 0, link = 0;  // indices into Scene::robots and Robot::links
};

// Allocates in its constructor only.
class PoseQuestion {
 public:
  explicit PoseQuestion(std::vector<AskedBody> bodies)
      : bodies_(std::move(bodies)), poses_(bodies_.size()) {}

  // The tick thread. All poses are those of the last tick.
  void answer(const Monitor& monitor) noexcept {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      const AskedBody& body = bodies_[i];
      poses_[i] = body.is_link ? monitor.present_link(body.robot, body.link)
                               : monitor.present_pose(body.object);
    }
    answered_.store(true, std::memory_order_release);
  }

  [[nodiscard]] bool is_answered() const noexcept {
    return answered_.load(std::memory_order_acquire);
  }
  // Once it is answered: in the order of the bodies.
  [[nodiscard]] std::span<const PresentPose> poses() const noexcept { return poses_; }

 private:
  std::vector<AskedBody> bodies_;
  std::vector<PresentPose> poses_;
  std::atomic<bool> answered_{false};
};

}  // namespace clearance
