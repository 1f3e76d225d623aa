// Finds the ticks in which something happens that is worth a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "config/scene/scene.hpp"
#include "monitor/interface/report.hpp"

namespace clearance {

struct RecordedEvent {
  enum class Cause : std::uint8_t { kZone, kFault, kCommand };
  Cause cause = Cause::kZone;
  std::string what;  // a sentence without its full stop
};
[[nodiscard]] const char* name(RecordedEvent::Cause cause) noexcept;

// Events are the beginnings of states, so a state that lasts is one event:
//   zone   a zone becomes active
//   fault  pairs become stale or unknown; an allowed contact becomes too deep or too late; samples
//          are refused after at least `quiet_ns` without a refused one
class EventWatch {
 public:
  explicit EventWatch(std::int64_t quiet_ns) : quiet_ns_(quiet_ns) {}

  // The event of a tick; to be called for each. The first tick of a run is no fault: inputs are yet
  // to come.
  [[nodiscard]] std::optional<RecordedEvent> find(const Report& report, const Scene& scene);

  // Another scene is in force.
  void change() noexcept { was_unsure_ = was_too_deep_ = true; }

 private:
  std::int64_t quiet_ns_;
  bool was_unsure_ = true, was_too_deep_ = true;
  std::uint64_t rejected_ = 0;
  std::optional<std::int64_t> rejected_ns_;  // the last refusal
};

}  // namespace clearance
