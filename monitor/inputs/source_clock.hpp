// How the stamps of one source relate to the tick's time.
//
// Stamps are CLOCK_REALTIME of the machine that sends them. A source that is heard for the first
// time is taken to have this machine's clock, so its stamps less TickTime::clock_offset_ns are in
// the tick's time. When this machine's clock is stepped the offset changes at once; whether the
// source's stamps are stepped with it (a program here) or not (another machine, or a pose that was
// under way) only they can show. So the old relation holds, by which no pose is taken for younger
// than it is, until for half a second every pose has been on time by the new one and none by the
// old one. Poses that are held up come all at once in the end, so not all of them can be on time.
// Where the new relation makes all poses older, those that are on time by both do not count
// against it: what is in the future by the old one shows that it is wrong, and nobody gets younger.
#pragma once

#include <cstdint>

#include "monitor/inputs/tick_time.hpp"

namespace clearance {

class SourceClock {
 public:
  static constexpr std::int64_t kConfirmedAfterNs = 500'000'000;

  // Between which a pose is on time.
  struct Limits {
    std::int64_t future_ns = 0;  // not farther ahead of now
    std::int64_t age_ns = 0;     // not older
  };

  // A stamp of this source in the tick's time.
  [[nodiscard]] std::int64_t in_tick_time(std::int64_t stamp_ns, const TickTime& time,
                                          const Limits& limits) noexcept;

  // After a tick that does not know how much time has passed.
  void forget() noexcept { *this = {}; }

 private:
  // Whether the new relation, by which the stamp is `new_ns`, has been confirmed.
  [[nodiscard]] bool confirms(std::int64_t new_ns, std::int64_t old_ns, std::int64_t now_ns,
                              const Limits& limits) noexcept;

  bool heard_ = false;
  std::int64_t offset_ns_ = 0;  // stamps less the tick's time
  // Whether the new relation agrees with all that was heard since then, in the tick's time, and the
  // old one with nothing, or with nothing that it does not make younger.
  bool agrees_ = false;
  std::int64_t agrees_since_ns_ = 0;
};

}  // namespace clearance
