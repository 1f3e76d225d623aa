// The state of another daemon's ticks, with which the ticks of this one go on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "monitor/inputs/scene_ids.hpp"
#include "monitor/tick/monitor.hpp"
#include "monitor/tick/saved_state.hpp"

namespace clearance {

// A preparing thread makes it and fills it. TickState::join() then exchanges its own state for this
// one between two ticks.
class JoinedState {
 public:
  // `similar`: that of Monitor.
  explicit JoinedState(const Scene& scene, const Monitor* similar = nullptr)
      : scene_(scene), monitor_(std::make_unique<Monitor>(scene, similar)), ids_(scene) {}

  // Reads the bytes of save_state(). False: they do not fit this scene, or have values that no
  // monitor of it can have.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes, std::uint64_t lineage) {
    lineage_ = lineage;
    return restore_state(bytes, scene_, ids_, *monitor_);
  }

  [[nodiscard]] bool has_joined() const noexcept { return has_joined_; }
  [[nodiscard]] std::uint64_t lineage() const noexcept { return lineage_; }
  [[nodiscard]] std::uint64_t revision() const noexcept { return ids_.revision(); }

 private:
  friend class TickState;

  const Scene& scene_;  // outlives this
  std::unique_ptr<Monitor> monitor_;
  SceneIds ids_;
  std::uint64_t lineage_ = 0;
  bool has_joined_ = false;
};

}  // namespace clearance
