// The monitor of a changed scene, from its construction until the loop ticks it.
//
// A preparing thread makes it while the loop ticks the monitor before it:
//
//   preparing thread    constructs the successor, offers it to the loop
//   tick thread         begin(): the successor takes over what is known, between two ticks
//   preparing thread    catch_up(): runs the ticks that the loop has run since, from its records
//   tick thread         succeed(): between two ticks, once both monitors stand at the same cycle
//
// So a change costs the tick thread a copy of the objects' states and of a few ticks' samples. The
// bounds of pairs are found in the other thread. Which ticks the successor runs follows from the
// cycles of begin() and succeed() alone: a replay that is told both gets the same bits.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "config/scene/scene_map.hpp"
#include "monitor/inputs/scene_ids.hpp"
#include "monitor/inputs/scene_in_force.hpp"
#include "monitor/loop/loop_statistics.hpp"
#include "monitor/loop/ports.hpp"
#include "monitor/loop/tick_records.hpp"
#include "monitor/monitor.hpp"

namespace clearance {

class Successor {
 public:
  enum class State : std::uint8_t {
    kOffered,       // the loop has not begun
    kCatchingUp,    // the preparing thread runs ticks
    kSucceeded,     // the loop ticks it
    kTooManyNames,  // both scenes name more than kMaxSources sources
    kTooSlow,       // the loop ran more ticks than there is room for
  };
  // The ticks for which a successor waits to be certified: a cell whose budget is too small for its
  // pairs may never be.
  static constexpr std::size_t kMostUncertified = 256;

  // Allocates all memory but the records'. `running` is the loop's monitor of the scene `before`,
  // and may tick meanwhile. Both scenes and the records, which are cleared, outlive the use of this
  // object. `sinks` get the reports of the changed scene, from the first one on.
  Successor(const Scene& before, const Monitor& running, const Scene& scene,
            std::vector<ReportSink*> sinks, TickRecords& records);

  // Any thread.
  [[nodiscard]] State state() const noexcept { return state_.load(std::memory_order_acquire); }
  [[nodiscard]] bool failed() const noexcept {
    return state() == State::kTooManyNames || state() == State::kTooSlow;
  }
  // The cycle after which it took over, and the first one that it reports. 0: not yet.
  [[nodiscard]] std::uint64_t began_after() const noexcept { return began_after_.load(); }
  [[nodiscard]] std::uint64_t in_force_from() const noexcept { return in_force_from_.load(); }
  [[nodiscard]] SceneInForce in_force() const noexcept {
    return {.began_after = began_after(), .from = in_force_from()};
  }

  // The preparing thread, after begin() and before catch_up(): the state that it took over.
  [[nodiscard]] const Monitor& monitor() const noexcept { return *monitor_; }
  [[nodiscard]] const SourceNumbers& numbers() const noexcept { return numbers_; }

  // The preparing thread: runs the ticks that wait. Returns their number.
  std::size_t catch_up() noexcept;

  // The other members are for the tick thread. None allocates, throws or locks.
  // Between two ticks: takes over from the monitor of the constructor.
  void begin(const Monitor& running, SourceNumbers& numbers) noexcept;
  // After begin(): a tick that the running monitor gets, with whether its report was certified.
  void record(std::span<const PoseSample> samples, std::span<const JointSample> joints,
              const TickTime& time, bool certified) noexcept;
  // The successor has run all ticks up to this one. If the last report of the running monitor was
  // certified, then so is that of the successor, unless inputs that it watches are late, unknown or
  // absent, or kMostUncertified ticks in a row were not enough.
  [[nodiscard]] bool has_caught_up(std::uint64_t cycle) const noexcept {
    return caught_up_at_.load(std::memory_order_acquire) == cycle;
  }
  // Exchanges the monitor, statistics, sinks and ids of the loop for those of the successor.
  void succeed(std::unique_ptr<Monitor>& monitor, LoopStatistics& statistics,
               std::vector<ReportSink*>& sinks, SceneIds& ids) noexcept;

  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }
  // Returns the figures of the former scene. Only the preparing thread calls this, after succeed().
  [[nodiscard]] const LoopStatistics& statistics() const noexcept { return statistics_; }

 private:
  template <class Sample>
  static void take(SpscRing<Sample>& ring, std::size_t count, std::span<const std::uint32_t> now,
                   std::uint32_t Sample::*input, std::vector<Sample>& taken) noexcept;

  const Scene& scene_;
  SceneMap map_;
  std::unique_ptr<Monitor> monitor_;
  SourceNumbers numbers_;  // after begin()
  LoopStatistics statistics_;
  std::vector<ReportSink*> sinks_;
  TickRecords& records_;
  std::size_t uncertified_ = 0;  // ticks in a row
  std::atomic<State> state_{State::kOffered};
  std::atomic<std::uint64_t> began_after_{0}, in_force_from_{0}, caught_up_at_{0};
};

}  // namespace clearance
