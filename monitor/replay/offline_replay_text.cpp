// What a replay tells a person.
#include <cstdio>

#include "monitor/replay/offline_replay.hpp"

namespace clearance {

std::string TickNumber::text() const {
  const std::string name = "tick " + std::to_string(cycle);
  if (recorded == cycle) return name;
  return name + " of the replay, " + std::to_string(recorded) + " of the daemon";
}

std::string OfflineReplay::text() const {
  std::string out;
  const auto line = [&out](const std::string& what) { out.append(what).append("\n"); };
  if (!error.empty()) line(error);
  for (const ReplayFailure& failure : failures) {
    if (failure.tick.cycle == 0) {
      line(failure.what);
      continue;
    }
    std::array<char, 32> when;
    std::snprintf(when.data(), when.size(), " (%.6f s): ", failure.time_s);
    line(failure.tick.text() + when.data() + failure.what);
  }
  if (!damage.empty()) line(damage);
  if (stopped) {
    line("stopped after " + std::to_string(ticks) +
         " ticks: nothing is known of the rest of the recording");
  }
  for (const std::string& note : notes) line(note);
  return out;
}

}  // namespace clearance
