// The state of another daemon's ticks, from which a loop goes on.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "monitor/inputs/scene_ids.hpp"
#include "monitor/loop/frame_exchange.hpp"
#include "monitor/monitor.hpp"
#include "monitor/saved_state.hpp"

namespace clearance {

// A preparing thread makes it, fills it and offers it to the loop, which exchanges its own monitor
// for this one between two ticks. The scene is that of the loop.
class JoinedState {
 public:
  explicit JoinedState(const Scene& scene)
      : monitor_(std::make_unique<Monitor>(scene)), ids_(scene) {}

  // Takes the bytes of save_state(). False: they do not fit this scene.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes, std::uint64_t lineage) {
    lineage_ = lineage;
    return restore_state(bytes, ids_, *monitor_);
  }

  // Tick thread: the frames of sensors that this state has in use have come.
  [[nodiscard]] bool has_frames(FrameExchange& frames) const noexcept {
    return frames.has_awaited(*monitor_);
  }
  // Tick thread: exchanges what the loop ticks. Leaves everything as it is if the scene of the loop
  // has another revision by now.
  void join(std::unique_ptr<Monitor>& monitor, SceneIds& ids) noexcept {
    has_joined_ = ids.revision() == ids_.revision();
    if (!has_joined_) return;
    std::swap(monitor_, monitor);
    std::swap(ids_, ids);
  }
  [[nodiscard]] bool has_joined() const noexcept { return has_joined_; }
  [[nodiscard]] std::uint64_t lineage() const noexcept { return lineage_; }
  [[nodiscard]] std::uint64_t revision() const noexcept { return ids_.revision(); }

 private:
  std::unique_ptr<Monitor> monitor_;
  SceneIds ids_;
  std::uint64_t lineage_ = 0;
  bool has_joined_ = false;
};

}  // namespace clearance
