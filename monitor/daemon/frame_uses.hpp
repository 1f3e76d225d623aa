// The frames of sensors that ticks are shown, on their path from the tick thread to a recording.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "config/scene/sensor.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/tick/spsc_ring.hpp"

namespace clearance {

class FrameUses final : public ReportSink {
 public:
  struct Use {
    std::uint32_t sensor = 0;
    std::int64_t stamp_ns = 0;
    std::uint64_t cycle = 0;  // of the tick
  };

  // Tick thread.
  void input(const PoseBatch& /*batch*/) noexcept override {}
  void frame(std::uint32_t sensor, std::int64_t stamp_ns) noexcept override {
    if (shown_ < of_tick_.size()) of_tick_[shown_++] = {sensor, stamp_ns, 0};
  }
  void report(const Report& report, std::span<const SourceUse> /*sources*/) noexcept override {
    for (std::size_t i = 0; i < shown_; ++i) {
      Use* const slot = uses_.back();
      if (slot == nullptr) break;  // the recording then lacks the frame, which a replay finds
      *slot = of_tick_[i];
      slot->cycle = report.cycle;
      uses_.push();
    }
    shown_ = 0;
  }
  void statistics(const LoopStatistics& /*statistics*/) noexcept override {}

  // Recording thread. Uses of a tick are here before its report is in a queue whose sink comes
  // behind this one.
  [[nodiscard]] SpscRing<Use>& uses() noexcept { return uses_; }

 private:
  std::array<Use, kMaxSensors> of_tick_;
  std::size_t shown_ = 0;
  SpscRing<Use> uses_{1024};
};

}  // namespace clearance
