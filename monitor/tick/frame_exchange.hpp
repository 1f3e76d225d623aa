// Hands frames of sensors to the tick thread without a lock.
//
//   building thread   is_used(), put(); note_built()
//   tick thread       before each tick: choose_all(), or choose() for those that a partner has,
//   too;
//                     then show()
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
#include <vector>

#include "monitor/tick/monitor.hpp"

namespace clearance {

// A frame that the coming tick is shown.
struct ShownFrame {
  std::uint32_t sensor = 0;
  std::int64_t stamp_ns = 0;
};

class FrameExchange {
 public:
  // Clouds of one sensor that may be in use at once: by the tick, by the tick that takes the next
  // one, by the frame that a tick may choose, and by the one that has come since.
  static constexpr std::size_t kMostUsed = 4;

  // Allocates all memory.
  explicit FrameExchange(std::size_t sensors)
      : sensors_(sensors), of_(std::make_unique<OfSensor[]>(sensors)) {
    shown_.reserve(2 * sensors);  // an awaited one, and the one that is chosen
  }

  // Building thread: a coming tick of the scene of this revision takes this frame, unless a newer
  // one comes first.
  void put(std::uint32_t sensor, const SensorFrame& frame, std::uint64_t scene_revision) noexcept;
  // Building thread: true while the tick or a frame that waits uses the cloud.
  [[nodiscard]] bool is_used(const SeenCloud* cloud) const noexcept;
  // Building thread: the partner has built the frame of this content (monitor/loop).
  void note_built(std::uint32_t sensor, std::uint64_t content) noexcept {
    of_[sensor].built.store(content, std::memory_order_relaxed);
  }

  // The other members are for the tick thread, between two ticks of the scene of this revision.
  // None allocates, throws or locks.
  [[nodiscard]] std::size_t sensors() const noexcept { return sensors_; }
  // The newest frame that has come and was not shown; null: none.
  const SensorFrame* newest(std::uint32_t sensor, std::uint64_t scene_revision) noexcept;
  // The same, while a partner is to build it, too: the frame that was found before stays until its
  // answer, or that of a newer one, has come. Otherwise no answer of a partner that needs longer
  // than the time between two frames would count.
  const SensorFrame* awaiting_answer(std::uint32_t sensor, std::uint64_t scene_revision) noexcept;
  // The partner's note_built() of that frame has come.
  [[nodiscard]] bool is_built(std::uint32_t sensor, std::uint64_t content) const noexcept {
    return of_[sensor].built.load(std::memory_order_relaxed) == content;
  }
  // A frame of this content has come and was not shown. If not, the older one that waits may go.
  [[nodiscard]] bool has(std::uint32_t sensor, std::uint64_t content) noexcept;
  // The next tick is shown the frame that newest() or has() found.
  void choose(std::uint32_t sensor) noexcept {
    of_[sensor].is_chosen = of_[sensor].next != nullptr;
  }
  void choose_all(std::uint64_t scene_revision) noexcept;
  // Shows the monitor of the scene what was chosen.
  void show(std::uint64_t scene_revision, Monitor& monitor) noexcept;

  // All frames that the monitor awaits have come (Monitor::awaited_frame).
  [[nodiscard]] bool has_awaited(const Monitor& monitor) noexcept;
  // Shows those that have come to the monitor, which takes the place of the one before.
  void show_awaited(Monitor& monitor) noexcept;

  // All that was shown since forget_shown().
  [[nodiscard]] std::span<const ShownFrame> shown() const noexcept { return shown_; }
  void forget_shown() noexcept { shown_.clear(); }

 private:
  // One more, which is free for put().
  struct Slot {
    SensorFrame frame;
    std::uint64_t scene_revision = 0;
    std::atomic<std::uint64_t> content{0};  // of the frame, for a look while it is offered
    std::atomic<bool> is_used{false};
  };
  struct OfSensor {
    std::array<Slot, kMostUsed + 1> slots;
    std::atomic<Slot*> offered{nullptr};
    std::atomic<std::uint64_t> built{0};
    // Tick thread. Taken from `offered`, and not shown yet.
    Slot* next = nullptr;
    bool is_chosen = false;
    // Shown, and not given back. After each tick, at most one is in use.
    std::array<Slot*, 2> held{};
  };
  static void take_offer(OfSensor& of) noexcept;
  static void give_back(OfSensor& of, const Monitor& monitor) noexcept;
  void show(OfSensor& of, std::uint32_t sensor, Monitor& monitor) noexcept;

  std::size_t sensors_;
  std::unique_ptr<OfSensor[]> of_;
  // Tick thread.
  std::uint64_t revision_ = 0;  // of the last show()
  std::vector<ShownFrame> shown_;
};

}  // namespace clearance
