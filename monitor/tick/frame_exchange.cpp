#include "monitor/tick/frame_exchange.hpp"

#include <algorithm>
#include <utility>

#include "monitor/interface/invariant.hpp"

namespace clearance {

void FrameExchange::put(std::uint32_t sensor, const SensorFrame& frame,
                        std::uint64_t scene_revision) noexcept {
  OfSensor& of = of_[sensor];
  const auto free = std::ranges::find_if(
      of.slots, [](const Slot& slot) { return !slot.is_used.load(std::memory_order_acquire); });
  CLEARANCE_INVARIANT(free != of.slots.end());
  free->frame = frame;
  free->scene_revision = scene_revision;
  free->content.store(frame.content, std::memory_order_relaxed);
  free->is_used.store(true, std::memory_order_relaxed);
  Slot* const before = of.offered.exchange(&*free, std::memory_order_acq_rel);
  if (before != nullptr) before->is_used.store(false, std::memory_order_release);
}

bool FrameExchange::is_used(const SeenCloud* cloud) const noexcept {
  for (std::size_t sensor = 0; sensor < sensors_; ++sensor) {
    for (const Slot& slot : of_[sensor].slots) {
      if (slot.is_used.load(std::memory_order_acquire) && slot.frame.cloud == cloud) return true;
    }
  }
  return false;
}

// A newer frame takes the place of the one that waits.
void FrameExchange::take_offer(OfSensor& of) noexcept {
  if (of.offered.load(std::memory_order_relaxed) == nullptr) return;
  Slot* const before =
      std::exchange(of.next, of.offered.exchange(nullptr, std::memory_order_acq_rel));
  if (before != nullptr) before->is_used.store(false, std::memory_order_release);
  of.is_chosen = false;
}

const SensorFrame* FrameExchange::newest(std::uint32_t sensor,
                                         std::uint64_t scene_revision) noexcept {
  OfSensor& of = of_[sensor];
  take_offer(of);
  if (of.next != nullptr && of.next->scene_revision != scene_revision)
    std::exchange(of.next, nullptr)->is_used.store(false, std::memory_order_release);
  return of.next == nullptr ? nullptr : &of.next->frame;
}

const SensorFrame* FrameExchange::awaiting_answer(std::uint32_t sensor,
                                                  std::uint64_t scene_revision) noexcept {
  OfSensor& of = of_[sensor];
  if (of.next == nullptr || of.next->scene_revision != scene_revision)
    return newest(sensor, scene_revision);
  const Slot* const offered = of.offered.load(std::memory_order_acquire);
  const bool is_newer_built =
      offered != nullptr && is_built(sensor, offered->content.load(std::memory_order_relaxed));
  return is_newer_built ? newest(sensor, scene_revision) : &of.next->frame;
}

bool FrameExchange::has(std::uint32_t sensor, std::uint64_t content) noexcept {
  OfSensor& of = of_[sensor];
  if (of.next == nullptr || of.next->frame.content != content) take_offer(of);
  return of.next != nullptr && of.next->frame.content == content;
}

void FrameExchange::choose_all(std::uint64_t scene_revision) noexcept {
  for (std::uint32_t sensor = 0; sensor < sensors_; ++sensor) {
    static_cast<void>(newest(sensor, scene_revision));
    choose(sensor);
  }
}

// A frame that was shown is in use by now, or was refused.
void FrameExchange::give_back(OfSensor& of, const Monitor& monitor) noexcept {
  for (Slot*& slot : of.held) {
    if (slot == nullptr || monitor.uses(slot->frame.cloud)) continue;
    slot->is_used.store(false, std::memory_order_release);
    slot = nullptr;
  }
  if (of.held[0] == nullptr) std::swap(of.held[0], of.held[1]);
}

void FrameExchange::show(OfSensor& of, std::uint32_t sensor, Monitor& monitor) noexcept {
  Slot* const slot = std::exchange(of.next, nullptr);
  of.is_chosen = false;
  give_back(of, monitor);
  if (!monitor.show(sensor, slot->frame)) {
    slot->is_used.store(false, std::memory_order_release);
    return;
  }
  (of.held[0] == nullptr ? of.held[0] : of.held[1]) = slot;
  if (shown_.size() < shown_.capacity()) shown_.push_back({sensor, slot->frame.stamp_ns});
}

void FrameExchange::show(std::uint64_t scene_revision, Monitor& monitor) noexcept {
  // Another monitor uses none of the clouds that the one before used.
  const bool is_other = std::exchange(revision_, scene_revision) != scene_revision;
  for (std::uint32_t sensor = 0; sensor < sensors_; ++sensor) {
    OfSensor& of = of_[sensor];
    if (is_other || of.held[1] != nullptr) give_back(of, monitor);
    if (of.is_chosen) show(of, sensor, monitor);
  }
}

bool FrameExchange::has_awaited(const Monitor& monitor) noexcept {
  for (std::uint32_t sensor = 0; sensor < sensors_; ++sensor) {
    const std::uint64_t content = monitor.awaited_frame(sensor);
    const bool is_held = std::ranges::any_of(of_[sensor].held, [content](const Slot* slot) {
      return slot != nullptr && slot->frame.content == content;
    });
    if (content != 0 && !is_held && !has(sensor, content)) return false;
  }
  return true;
}

void FrameExchange::show_awaited(Monitor& monitor) noexcept {
  for (std::uint32_t sensor = 0; sensor < sensors_; ++sensor) {
    OfSensor& of = of_[sensor];
    const std::uint64_t content = monitor.awaited_frame(sensor);
    if (content == 0) continue;
    for (const Slot* const slot : of.held) {
      if (slot != nullptr && slot->frame.content == content)
        static_cast<void>(monitor.show(sensor, slot->frame));
    }
    if (monitor.awaited_frame(sensor) != 0 && has(sensor, content)) show(of, sensor, monitor);
  }
}

}  // namespace clearance
