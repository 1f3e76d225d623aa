// The state of another daemon's ticks, from which a loop goes on.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "monitor/inputs/scene_ids.hpp"
#include "monitor/monitor.hpp"

namespace clearance {

// A preparing thread makes it, fills it and offers it to the loop, which exchanges its own monitor
// for this one between two ticks. The scene is that of the loop.
class JoinedState {
 public:
  explicit JoinedState(const Scene& scene)
      : monitor_(std::make_unique<Monitor>(scene)), numbers_(scene), revision_(scene.revision) {}

  // Takes the bytes of save_state(). False: they do not fit this scene.
  [[nodiscard]] bool restore(std::span<const std::byte> bytes, std::uint64_t lineage) noexcept {
    StateReader in(bytes);
    in.take(numbers_);
    lineage_ = lineage;
    return monitor_->restore(in);
  }

  // Tick thread: exchanges what the loop ticks. Leaves everything as it is if the scene of the loop
  // has another revision by now.
  void join(std::unique_ptr<Monitor>& monitor, SceneIds& ids) noexcept {
    has_joined_ = ids.revision() == revision_;
    if (!has_joined_) return;
    std::swap(monitor_, monitor);
    ids.sources() = numbers_;
  }
  [[nodiscard]] bool has_joined() const noexcept { return has_joined_; }
  [[nodiscard]] std::uint64_t lineage() const noexcept { return lineage_; }
  [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

 private:
  std::unique_ptr<Monitor> monitor_;
  SourceNumbers numbers_;
  std::uint64_t revision_, lineage_ = 0;
  bool has_joined_ = false;
};

// The bytes of a monitor that has taken over and not ticked yet, with the numbers of its sources.
inline void save_state(const SourceNumbers& numbers, const Monitor& monitor,
                       std::vector<std::byte>& bytes) {
  StateWriter out(bytes);
  out.put(numbers);
  monitor.save(out);
}

}  // namespace clearance
