// The three ports of the fixed-rate loop: the source of poses, the sinks of reports, and the clock.
//
// The daemon puts Cyclone DDS and the kernel's clocks behind them, the tests a list of batches and
// a clock of their own. All are called from the tick thread: none may block (but for sleep_until),
// allocate or throw.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/inputs/pose_batch.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/report.hpp"

namespace clearance {

// Where poses come from.
class PoseSource {
 public:
  virtual ~PoseSource() = default;
  // The next batch in the order of arrival, or null when none is waiting. Valid until the next
  // call.
  virtual const PoseBatch* next() noexcept = 0;
};

// Where reports go. What a sink wants to keep it copies.
class ReportSink {
 public:
  virtual ~ReportSink() = default;
  // A batch that the coming tick takes in; called in the order in which it does.
  virtual void input(const PoseBatch& batch) noexcept = 0;
  // `sources`: the last batch of each source that this tick took in; empty when there was none.
  virtual void report(const Report& report, std::span<const SourceUse> sources) noexcept = 0;
  // Once a second, and after the last tick.
  virtual void statistics(const LoopStatistics& statistics) noexcept = 0;
};

// Realtime for stamps that other machines compare; two that cannot be stepped: monotonic for
// deadlines, and steady, which goes on while the machine sleeps, for ages.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t realtime_ns() noexcept = 0;   // stamps: CLOCK_REALTIME
  virtual std::int64_t monotonic_ns() noexcept = 0;  // deadlines: CLOCK_MONOTONIC
  virtual std::int64_t steady_ns() noexcept = 0;     // ages: CLOCK_BOOTTIME
  virtual void sleep_until(std::int64_t monotonic_ns) noexcept = 0;
};

// The kernel's clocks.
class SystemClock final : public Clock {
 public:
  std::int64_t realtime_ns() noexcept override;
  std::int64_t monotonic_ns() noexcept override;
  std::int64_t steady_ns() noexcept override;
  void sleep_until(std::int64_t monotonic_ns) noexcept override;
};

}  // namespace clearance
