// Decides together with another daemon when ticks are, and on which inputs they rest.
#pragma once

#include <cstdint>

#include "monitor/inputs/tick_time.hpp"
#include "monitor/tick/monitor.hpp"

namespace clearance {

// monitor/loop implements it. The PoseSource of the loop then hands out what was decided. All
// calls are those of the tick thread.
class TickPace {
 public:
  virtual ~TickPace() = default;
  // The time before a deadline at which decide() is to be called.
  [[nodiscard]] virtual std::int64_t ahead_ns() const noexcept = 0;
  // Before decide(): what a leading daemon tells its tick (TickTime::report_delay_ns).
  virtual void note_report_delay(std::int64_t /*ns*/) noexcept {}
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

}  // namespace clearance
