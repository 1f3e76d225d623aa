// Hands frames of sensors to the tick thread without a lock.
//
//   building thread   is_used(), put()
//   tick thread       show(), before each tick
//
// The cloud of a frame belongs to the building thread until put(). It belongs to it again when a
// newer frame has come before a tick took it, or when the tick does not use it any more.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "monitor/loop/ports.hpp"
#include "monitor/monitor.hpp"

namespace clearance {

class FrameExchange {
 public:
  // Clouds of one sensor that may be in use at once: by the tick, by the tick that takes the next
  // one, and by the frame that waits.
  static constexpr std::size_t kMostUsed = 3;

  // Allocates all memory.
  explicit FrameExchange(std::size_t sensors)
      : sensors_(sensors), of_(std::make_unique<OfSensor[]>(sensors)) {}

  // Building thread: the next tick of the scene of this revision takes this frame, unless a newer
  // one comes first.
  void put(std::uint32_t sensor, const SensorFrame& frame, std::uint64_t scene_revision) noexcept;
  // Building thread: true while the tick or a frame that waits uses the cloud.
  [[nodiscard]] bool is_used(const SeenCloud* cloud) const noexcept;

  // Tick thread, between two ticks: shows the monitor what has come, and tells the sinks. `monitor`
  // is that of the scene of this revision. Does not allocate, throw or lock.
  void show(std::uint64_t scene_revision, Monitor& monitor,
            std::span<ReportSink* const> sinks) noexcept;

 private:
  // Four, so that one is free for put().
  struct Slot {
    SensorFrame frame;
    std::uint64_t scene_revision = 0;
    std::atomic<bool> is_used{false};
  };
  struct OfSensor {
    std::array<Slot, kMostUsed + 1> slots;
    std::atomic<Slot*> offered{nullptr};
    // Tick thread: taken from `offered` and not given back. After each tick, at most one is in use.
    std::array<Slot*, 2> held{};
  };
  static void give_back(OfSensor& of, const Monitor& monitor) noexcept;

  std::size_t sensors_;
  std::unique_ptr<OfSensor[]> of_;
  std::uint64_t revision_ = 0;  // tick thread: of the last show()
};

}  // namespace clearance
