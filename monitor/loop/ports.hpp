// The three ports of the fixed-rate loop: the source of poses, the sinks of reports, and the clock.
//
// The daemon puts Cyclone DDS and the kernel's clocks behind them; tests put a list of batches and
// a clock of their own there. The tick thread calls all of them: none may block (except
// sleep_until), allocate or throw.
#pragma once

#include <cstdint>
#include <span>

#include "monitor/inputs/pose_batch.hpp"
#include "monitor/inputs/tick_time.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/report.hpp"

namespace clearance {

// A source of poses.
class PoseSource {
 public:
  virtual ~PoseSource() = default;
  // The next batch in the order of arrival, or null when none waits. It is valid until the next
  // call.
  virtual const PoseBatch* next() noexcept = 0;
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
  // The report that follows is of this lineage (monitor/partners). Partners only.
  virtual void lineage(std::uint64_t /*lineage*/) noexcept {}
  // The tick of the report that follows goes on from the state of a partner, which was taken for
  // this lineage. Partners only.
  virtual void joined(std::uint64_t /*lineage*/) noexcept {}
  // `sources`: the last batch of each source that this tick used; empty when there was none.
  virtual void report(const Report& report, std::span<const SourceUse> sources) noexcept = 0;
  // Once a second, and after the last tick.
  virtual void statistics(const LoopStatistics& statistics) noexcept = 0;
};

// Decides together with another daemon when ticks are, and on which inputs they rest
// (monitor/partners). The PoseSource of the loop then hands out what was decided. Tick thread.
class TickPace {
 public:
  virtual ~TickPace() = default;
  // The time before a deadline at which decide() is to be called.
  [[nodiscard]] virtual std::int64_t ahead_ns() const noexcept = 0;
  // Decides on the next tick of the scene of this revision, which will have this cycle, and sleeps
  // until it is due. Returns its deadline, CLOCK_MONOTONIC: `deadline` or that of the partner.
  virtual std::int64_t decide(std::int64_t deadline, std::uint64_t cycle,
                              std::uint64_t revision) noexcept = 0;
  // After decide(): the time that the tick is told.
  [[nodiscard]] virtual TickTime time() noexcept = 0;
  // After the tick, before its report is handed over.
  virtual void ticked(const Monitor& monitor) noexcept = 0;
  // The lineage of that tick: those of one lineage and cycle rest on the same inputs.
  [[nodiscard]] virtual std::uint64_t lineage() const noexcept = 0;
  // The tick that follows is due already: no deadline is to be skipped.
  [[nodiscard]] virtual bool is_behind() noexcept = 0;

  // The scene changes in steps: a successor begins with the state after the last tick. Later it was
  // either given up, or it caught up and the loop ticks it from now on.
  virtual void successor_begins(bool same_scene) noexcept = 0;
  virtual void successor_gave_up() noexcept = 0;
  virtual void successor_followed() noexcept = 0;
  // Returns true while the two do not tick the same state: the loop may then take over the
  // partner's.
  [[nodiscard]] virtual bool may_join() const noexcept = 0;
  // The loop has taken over the partner's state, as it was after this cycle.
  virtual void joined(std::uint64_t lineage, std::uint64_t cycle) noexcept = 0;
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
