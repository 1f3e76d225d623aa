// The monitor of a changed scene, from its construction until it is the one that ticks.
//
// In a loop, a preparing thread makes it while the loop ticks the monitor before it:
//
//   preparing thread    constructs the successor, offers it to the loop
//   tick thread         TickState::begin(): it takes over what is known, between two ticks
//   preparing thread    catch_up(): runs the ticks that the loop has run since, from its records
//   tick thread         TickState::succeed(): between two ticks, once both stand at the same cycle
//
// A change costs the tick thread a copy of the objects' states and of a few ticks' samples. The
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
#include "monitor/tick/monitor.hpp"
#include "monitor/tick/saved_state.hpp"
#include "monitor/tick/tick_records.hpp"

namespace clearance {

class TickState;

class Successor {
 public:
  enum class State : std::uint8_t {
    kOffered,       // it has not begun
    kCatchingUp,    // the preparing thread runs ticks
    kSucceeded,     // it is the one that ticks
    kTooManyNames,  // both scenes name more than kMaxSources sources
    kTooSlow,       // the loop ran more ticks than there is room for
  };
  // The ticks for which a successor waits to be certified: a cell whose budget is too small for its
  // pairs may never be.
  static constexpr std::size_t kMostUncertified = 256;

  // Allocates all memory but the records'. `running` may tick meanwhile. Both scenes and the
  // records, which are cleared, outlive the use of this object.
  Successor(const TickState& running, const Scene& scene, TickRecords& records);

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
  [[nodiscard]] const Scene& scene() const noexcept { return scene_; }

  // The preparing thread, after begin() and before catch_up(): saves the state that it took over.
  // `ids` are those of the scene before.
  void save(const SceneIds& ids, std::vector<std::byte>& bytes) const {
    save_state(numbers_, ids, *monitor_, bytes);
  }
  // The preparing thread: runs the ticks that wait. Returns their number.
  std::size_t catch_up() noexcept;

  // Tick thread. True: it has run all ticks up to this one. If the last report of the running
  // monitor was certified, then so is that of the successor, unless inputs that it watches are
  // late, unknown or absent, or kMostUncertified ticks in a row were not enough.
  [[nodiscard]] bool has_caught_up(std::uint64_t cycle) const noexcept {
    return caught_up_at_.load(std::memory_order_acquire) == cycle;
  }

 private:
  friend class TickState;  // its tick thread calls these; none allocates, throws or locks

  // Takes over from the monitor of the constructor.
  void begin(const Monitor& running, SourceNumbers& numbers) noexcept;
  // A tick that the running monitor got, with whether its report was certified.
  void record(std::span<const PoseSample> samples, std::span<const JointSample> joints,
              const TickTime& time, bool certified) noexcept;
  void succeed(std::unique_ptr<Monitor>& monitor, SceneIds& ids) noexcept;

  void run(const TickTime& time, bool certified) noexcept;

  const Scene& scene_;
  SceneMap map_;
  std::unique_ptr<Monitor> monitor_;
  SourceNumbers numbers_;  // after begin()
  TickRecords& records_;
  std::size_t uncertified_ = 0;  // ticks in a row
  std::atomic<State> state_{State::kOffered};
  std::atomic<std::uint64_t> began_after_{0}, in_force_from_{0}, caught_up_at_{0};
};

}  // namespace clearance
