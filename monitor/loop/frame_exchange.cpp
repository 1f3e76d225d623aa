#include "monitor/loop/frame_exchange.hpp"

#include <algorithm>
#include <utility>

#include "monitor/invariant.hpp"

namespace clearance {

void FrameExchange::put(std::uint32_t sensor, const SensorFrame& frame,
                        std::uint64_t scene_revision) noexcept {
  OfSensor& of = of_[sensor];
  const auto free = std::ranges::find_if(
      of.slots, [](const Slot& slot) { return !slot.is_used.load(std::memory_order_acquire); });
  CLEARANCE_INVARIANT(free != of.slots.end());
  free->frame = frame;
  free->scene_revision = scene_revision;
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

// A frame that was shown is in use by now, or was refused.
void FrameExchange::give_back(OfSensor& of, const Monitor& monitor) noexcept {
  for (Slot*& slot : of.held) {
    if (slot == nullptr || monitor.uses(slot->frame.cloud)) continue;
    slot->is_used.store(false, std::memory_order_release);
    slot = nullptr;
  }
  if (of.held[0] == nullptr) std::swap(of.held[0], of.held[1]);
}

void FrameExchange::show(std::uint64_t scene_revision, Monitor& monitor,
                         std::span<ReportSink* const> sinks) noexcept {
  // Another monitor uses none of the clouds that the one before used.
  const bool is_other = std::exchange(revision_, scene_revision) != scene_revision;
  for (std::uint32_t sensor = 0; sensor < sensors_; ++sensor) {
    OfSensor& of = of_[sensor];
    if (is_other || of.held[1] != nullptr) give_back(of, monitor);
    if (of.offered.load(std::memory_order_relaxed) == nullptr) continue;
    Slot* const slot = of.offered.exchange(nullptr, std::memory_order_acq_rel);
    if (slot == nullptr) continue;
    give_back(of, monitor);
    if (slot->scene_revision != scene_revision || !monitor.show(sensor, slot->frame)) {
      slot->is_used.store(false, std::memory_order_release);
      continue;
    }
    (of.held[0] == nullptr ? of.held[0] : of.held[1]) = slot;
    for (ReportSink* const sink : sinks) sink->frame(sensor, slot->frame.stamp_ns);
  }
}

}  // namespace clearance
