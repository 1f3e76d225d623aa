// Converts the stamps of one source to the tick's time.
//
// Stamps are CLOCK_REALTIME of the machine that sends them. At first a source is assumed to have
// this machine's clock: its stamps less TickTime::clock_offset_ns are in the tick's time.
//
// The offset changes at once when this machine's clock is stepped. The source's stamps are stepped
// with it if the source runs on this machine. They are not if it runs on another machine, or if the
// pose was sent before the step. Only the stamps themselves can show which. The old offset
// therefore stays in use, with which no pose is taken for younger than it is. It is replaced when,
// for half a second, every pose has been on time by the new offset and none by the old. Delayed
// poses arrive all at once, so not all of them can be on time.
//
// If the new offset makes all poses older, poses that are on time by both offsets do not count
// against it. Poses that are in the future by the old offset show that it is wrong, and no pose
// becomes younger.
#pragma once

#include <cstdint>

#include "monitor/inputs/state_bytes.hpp"
#include "monitor/inputs/tick_time.hpp"

namespace clearance {

class SourceClock {
 public:
  static constexpr std::int64_t kConfirmedAfterNs = 500'000'000;

  // A pose within these limits is on time.
  struct Limits {
    std::int64_t future_ns = 0;  // how far the stamp may be ahead of now
    std::int64_t age_ns = 0;     // the largest age
  };

  // Converts a stamp of this source to the tick's time.
  [[nodiscard]] std::int64_t in_tick_time(std::int64_t stamp_ns, const TickTime& time,
                                          const Limits& limits) noexcept;

  // Call this after a tick that does not know how much time has passed.
  void forget() noexcept { *this = {}; }
  [[nodiscard]] bool is_sound() const noexcept { return are_flags(heard_, agrees_); }

 private:
  // Returns true if this stamp confirms the new offset. `new_ns` and `old_ns` are the stamp in the
  // tick's time by the new and the old offset.
  [[nodiscard]] bool confirms(std::int64_t new_ns, std::int64_t old_ns, std::int64_t now_ns,
                              const Limits& limits) noexcept;

  bool heard_ = false;
  std::int64_t offset_ns_ = 0;  // stamps less the tick's time
  // Every stamp since `agrees_since_ns_` was on time by the new offset. By the old offset it was
  // not on time, or younger than by the new one.
  bool agrees_ = false;
  std::int64_t agrees_since_ns_ = 0;
};

}  // namespace clearance
