// Remembers the state that was last written of each zone, so that zones are written on change only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace clearance {

// States are compared with what was written, not with ZoneReport::changed: a change must come
// through even when the report in which it happened was dropped.
class WrittenZones {
 public:
  explicit WrittenZones(std::size_t zones) : active_(zones) {}

  [[nodiscard]] bool any(std::uint32_t zone) const { return active_[zone].has_value(); }
  // Returns true when the last state written of this zone is `active`.
  [[nodiscard]] bool is(std::uint32_t zone, bool active) const { return active_[zone] == active; }
  void set(std::uint32_t zone, bool active) { active_[zone] = active; }
  // Nothing is known to be written of it any longer.
  void forget(std::uint32_t zone) { active_[zone].reset(); }

 private:
  std::vector<std::optional<bool>> active_;  // none: never written
};

}  // namespace clearance
