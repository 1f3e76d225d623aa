// Remembers the state that was last written of each zone, so that zones are written on change only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace clearance {

// The part of a state that is written anew when it changes: a client sees why a zone is active now,
// and not only why it was entered. The pair and the clearances of a state are those of the tick
// that it names.
struct WrittenZone {
  bool active = false;
  std::uint8_t cause = 0;
  std::uint32_t cause_object = 0;

  // Takes a ZoneReport or a state on the wire.
  template <class Zone>
  [[nodiscard]] static WrittenZone of(const Zone& zone) noexcept {
    return {zone.active, static_cast<std::uint8_t>(zone.cause), zone.cause_object};
  }
  [[nodiscard]] bool operator==(const WrittenZone&) const = default;
};

// States are compared with what was written, not with ZoneReport::changed: a change must come
// through even when the report in which it happened was dropped.
class WrittenZones {
 public:
  explicit WrittenZones(std::size_t zones) : last_(zones) {}

  // Nothing: never written.
  [[nodiscard]] const std::optional<WrittenZone>& last(std::uint32_t zone) const {
    return last_[zone];
  }
  [[nodiscard]] bool is_active(std::uint32_t zone) const {
    return last_[zone] && last_[zone]->active;
  }
  void set(std::uint32_t zone, const WrittenZone& state) { last_[zone] = state; }
  // Nothing is known to be written of it any longer.
  void forget(std::uint32_t zone) { last_[zone].reset(); }

 private:
  std::vector<std::optional<WrittenZone>> last_;
};

}  // namespace clearance
