// The state of another daemon's ticks, from which a loop goes on.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "monitor/inputs/scene_ids.hpp"
#include "monitor/loop/frame_exchange.hpp"
#include "monitor/monitor.hpp"

namespace clearance {

// A preparing thread makes it, fills it and offers it to the loop, which exchanges its own monitor
// for this one between two ticks. The scene is that of the loop.
class JoinedState {
 public:
  explicit JoinedState(const Scene& scene)
      : monitor_(std::make_unique<Monitor>(scene)), ids_(scene) {}

  // Takes the bytes of save_state(). False: they do not fit this scene.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes, std::uint64_t lineage) {
    StateReader in(bytes);
    in.take(ids_.sources());
    ids_.restore_former(in);
    lineage_ = lineage;
    return monitor_->restore(in);
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

// The bytes of a monitor that has taken over and not ticked yet, with the numbers of its sources at
// that time. Former scenes are those of `ids`.
inline void save_state(const SourceNumbers& numbers, const SceneIds& ids, const Monitor& monitor,
                       std::vector<std::byte>& bytes) {
  StateWriter out(bytes);
  out.put(numbers);
  ids.save_former(out);
  monitor.save(out);
}

}  // namespace clearance
