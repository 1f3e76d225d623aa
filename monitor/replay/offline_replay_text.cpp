// The result of a replay as text for a person.
#include <fmt/format.h>

#include "config/text/sentences.hpp"
#include "monitor/replay/offline_replay.hpp"

namespace clearance {

// Both numbers where they differ: one finds the tick in the replay, the other in the daemon's log.
std::string TickNumber::text() const {
  const std::string name = fmt::format("tick {}", cycle);
  if (recorded == cycle) return name;
  return fmt::format("{} of the replay, {} of the daemon", name, recorded);
}

// Errors first, then failures, then notes.
std::string OfflineReplay::text() const {
  std::string out;
  const auto line = [&out](const std::string& what) { out.append(what).append("\n"); };
  if (!error.empty()) line(error);
  for (const ReplayFailure& failure : failures) {
    if (failure.tick.cycle == 0) {
      line(failure.what);
      continue;
    }
    line(fmt::format("{} ({:.6f} s): {}", failure.tick.text(), failure.time_s, failure.what));
  }
  if (!damage.empty()) line(damage);
  if (stopped) {
    line(fmt::format("stopped after {}: nothing is known of the rest of the recording",
                     counted(ticks, "tick")));
  }
  for (const std::string& note : notes) line(note);
  return out;
}

}  // namespace clearance
