// The three ports of the fixed-rate loop: the source of poses, the sinks of reports, and the clock.
//
// The daemon puts Cyclone DDS and the kernel's clocks behind them; tests put a list of batches and
// a clock of their own there. The tick thread calls all of them: none may block (except
// sleep_until), allocate or throw.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "config/scene/sensor.hpp"
#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/interface/report.hpp"
#include "monitor/loop/loop_statistics.hpp"

namespace clearance {

// A source of poses.
class PoseSource {
 public:
  virtual ~PoseSource() = default;
  // The next batch in the order of arrival, or null when none waits. It is valid until the next
  // call.
  virtual const PoseBatch* next() noexcept = 0;
};

// The inputs whose age is a part of the response time: by number of the source, then by sensor.
inline constexpr std::size_t kMostInputs = kMaxSources + kMaxSensors;

// What the response times of a report consist of, but for its own delay.
struct ReportStart {
  std::int64_t told_ns = 0;  // the time of the tick, CLOCK_MONOTONIC
  // Of the oldest value that each input sent last, ns; -1: none lately.
  std::array<std::int64_t, kMostInputs> ages_ns{};
};

// A sink of reports. It copies what it keeps.
class ReportSink {
 public:
  virtual ~ReportSink() = default;
  // The coming tick is due at this time, CLOCK_MONOTONIC; only with TickLoopOptions::ahead_ns.
  virtual void expect(std::int64_t /*deadline_ns*/) noexcept {}
  // A batch that the coming tick uses; calls come in the order of use.
  virtual void input(const PoseBatch& batch) noexcept = 0;
  // The coming tick is shown the frame of this sensor with this stamp.
  virtual void frame(std::uint32_t /*sensor*/, std::int64_t /*stamp_ns*/) noexcept {}
  // The report that follows is of this lineage (monitor/loop). Partners only.
  virtual void lineage(std::uint64_t /*lineage*/) noexcept {}
  // The tick of the report that follows goes on from the state of a partner, which was taken for
  // this lineage. Partners only.
  virtual void joined(std::uint64_t /*lineage*/) noexcept {}
  // Of the report that follows.
  virtual void start(const ReportStart& /*start*/) noexcept {}
  // The longest that a report took from its `told_ns` until it was published, since the last call,
  // or until `now_ns` where it is not published yet, CLOCK_MONOTONIC. kNotMeasured: there is none,
  // or the sink does not publish.
  [[nodiscard]] virtual std::int64_t longest_delay(std::int64_t /*now_ns*/) noexcept {
    return TickTime::kNotMeasured;
  }
  // `sources`: the last batch of each source that this tick used; empty when there was none.
  virtual void report(const Report& report, std::span<const SourceUse> sources) noexcept = 0;
  // Called once per second, and after the last tick.
  virtual void statistics(const LoopStatistics& statistics) noexcept = 0;
};

// Three clocks: realtime for stamps that other machines compare, monotonic for deadlines, and
// steady for ages. The latter two cannot be stepped, and steady also runs while the machine sleeps.
class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::int64_t realtime_ns() noexcept = 0;   // stamps: CLOCK_REALTIME
  virtual std::int64_t monotonic_ns() noexcept = 0;  // deadlines: CLOCK_MONOTONIC
  virtual std::int64_t steady_ns() noexcept = 0;     // ages: CLOCK_BOOTTIME
  virtual void sleep_until(std::int64_t monotonic_ns) noexcept = 0;
  // The same without leaving the processor to others.
  virtual void stay_awake_until(std::int64_t monotonic_ns) noexcept { sleep_until(monotonic_ns); }
};

// The kernel's clocks.
class SystemClock final : public Clock {
 public:
  std::int64_t realtime_ns() noexcept override;
  std::int64_t monotonic_ns() noexcept override;
  std::int64_t steady_ns() noexcept override;
  void sleep_until(std::int64_t monotonic_ns) noexcept override;
  void stay_awake_until(std::int64_t monotonic_ns) noexcept override;
};

}  // namespace clearance
